#include "cmap/sim/seen_surface.hpp"

#include <vector>

#include "cmap/core/parallel.hpp"
#include "sim/option_check.hpp"
#include "sim/scene_data.hpp"

namespace cmap {
namespace {

constexpr double kTolerance_m = 0.01;

struct SeenFrom {
  Eigen::Isometry3d T_camera_world;
  Eigen::Vector3d center;  ///< relative to the scene's origin
};

bool sees(const SceneData& scene, const CameraModel& camera, const SeenFrom& view, const Eigen::Vector3f& point,
          double max_distance_m) {
  const Eigen::Vector3d ray = point.cast<double>() - view.center;
  const double distance = ray.norm();
  if (distance > max_distance_m || distance < kTolerance_m) return false;
  const auto pixel = project(camera, view.T_camera_world * Eigen::Vector3d(scene.mesh.origin + point.cast<double>()));
  if (!pixel || !is_inside(camera, *pixel)) return false;
  const Ray to_point{view.center.cast<float>(), (ray / distance).cast<float>(),
                     static_cast<float>(distance - kTolerance_m)};
  return !scene.caster.is_blocked(to_point);
}

}  // namespace

PointCloud seen_surface(const Scene& scene, const CameraModel& camera,
                        std::span<const Eigen::Isometry3d> T_world_camera, const SeenSurfaceOptions& options) {
  check(camera);
  require_between("max_distance_m", options.max_distance_m, 1e-3, 1e6);
  const PointCloud cloud = sample_surface(scene, options.points_per_m2, options.seed);
  const SceneData& data = scene.data();
  std::vector<SeenFrom> views;
  for (const Eigen::Isometry3d& pose : T_world_camera) {
    views.push_back({pose.inverse(), pose.translation() - data.mesh.origin});
  }
  Array<std::uint8_t> keep(cloud.size());
  parallel_chunks(cloud.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      keep[i] = 0;
      for (const SeenFrom& view : views) {
        if (!sees(data, camera, view, cloud.positions[i], options.max_distance_m)) continue;
        keep[i] = 1;
        break;
      }
    }
  });
  return select(cloud, keep);
}

}  // namespace cmap
