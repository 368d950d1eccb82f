#include "scene/scene_sampling.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/color.hpp"
#include "sensors/noise.hpp"

namespace cmap {
namespace {

constexpr std::size_t kChunk = 4096;  ///< its start is part of the seed

/// Area of triangles 0..i, m^2.
std::vector<double> cumulative_areas(const SceneMesh& mesh) {
  std::vector<double> sums(mesh.triangles.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d n = (mesh.vertices[t[1]].cast<double>() - a).cross(mesh.vertices[t[2]].cast<double>() - a);
    sum += 0.5 * n.norm();
    sums[i] = sum;
  }
  return sums;
}

/// Uniform in the triangle: Turk, "Generating Random Points in Triangles", Graphics Gems 1990.
Eigen::Vector3f point_in(const SceneMesh& mesh, std::uint32_t triangle, float s, float t) {
  const Triangle& corners = mesh.triangles[triangle];
  const float root = std::sqrt(s);
  return (1.0F - root) * mesh.vertices[corners[0]] + root * (1.0F - t) * mesh.vertices[corners[1]] +
         root * t * mesh.vertices[corners[2]];
}

Rgb8 to_bytes(const RgbF& color) { return to_rgb8(255.0F * Eigen::Vector3f(color[0], color[1], color[2])); }

}  // namespace

SurfaceSamples draw_samples(const SceneData& scene, double points_per_m2, std::uint64_t seed) {
  const std::vector<double> areas = cumulative_areas(scene.mesh);
  const double wanted = std::round(areas.back() * points_per_m2);
  if (!(points_per_m2 > 0.0) || !(wanted <= 2147483648.0)) {
    throw UsageError(fmt::format("points_per_m2 is {}: it must be positive, and give at most 2^31 points on {:.0f} m^2",
                                 points_per_m2, areas.back()));
  }
  const auto n = static_cast<std::size_t>(wanted);
  SurfaceSamples samples{Array<Eigen::Vector3f>(n), Array<std::uint32_t>(n)};
  parallel_chunks(n, kChunk, [&](std::size_t begin, std::size_t end) {
    SceneRandom random(seed * 0x2545f4914f6cdd1dULL + begin);
    for (std::size_t i = begin; i < end; ++i) {
      // One point in each of n equal parts of the area: uniform, and more even than independent draws.
      const double target =
          areas.back() * (static_cast<double>(i) + static_cast<double>(random.unit())) / static_cast<double>(n);
      const auto found = std::lower_bound(areas.begin(), areas.end() - 1, target) - areas.begin();
      const float s = random.unit(), t = random.unit();
      samples.triangles[i] = static_cast<std::uint32_t>(found);
      samples.positions[i] = point_in(scene.mesh, samples.triangles[i], s, t);
    }
  });
  return samples;
}

PointCloud colored(const SceneData& scene, SurfaceSamples samples) {
  Array<Rgb8> colors(samples.positions.size());
  parallel_chunks(colors.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t triangle = samples.triangles[i];
      colors[i] = to_bytes(scene.color({triangle, samples.positions[i], scene.normal_of(triangle)}));
    }
  });
  PointCloud cloud;
  cloud.origin = scene.mesh.origin;
  cloud.positions = std::move(samples.positions);
  cloud.colors = std::move(colors);
  return cloud;
}

PointCloud sample_surface(const Scene& scene, double points_per_m2, std::uint64_t seed) {
  return colored(scene.data(), draw_samples(scene.data(), points_per_m2, seed));
}

}  // namespace cmap
