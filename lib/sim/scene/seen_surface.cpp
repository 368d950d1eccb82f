#include "cmap/sim/seen_surface.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "capture/option_check.hpp"
#include "cmap/core/parallel.hpp"
#include "scene/scene_sampling.hpp"

namespace cmap {
namespace {

constexpr double kTolerance_m = 0.01;

struct SeenFrom {
  Eigen::Isometry3d T_camera_world;
  Eigen::Vector3d center;  ///< relative to the scene's origin
};

/// From the camera to just before the point; none where the picture does not show the point anyway.
std::optional<Ray> ray_to(const Eigen::Vector3d& point, const SeenFrom& view, const Eigen::Vector3d& origin,
                          const CameraModel& camera, double max_distance_m) {
  const Eigen::Vector3d ray = point - view.center;
  const double distance = ray.norm();
  if (distance > max_distance_m || distance < kTolerance_m) return std::nullopt;
  const auto pixel = project(camera, view.T_camera_world * (origin + point));
  if (!pixel || !is_inside(camera, *pixel)) return std::nullopt;
  return Ray{view.center.cast<float>(), (ray / distance).cast<float>(), static_cast<float>(distance - kTolerance_m)};
}

/// Rays cast together, and the points that they lead to.
class RayPacket {
 public:
  RayPacket(const RayCaster& caster, std::span<std::uint8_t> seen) : caster_(caster), seen_(seen) {}

  void add(const Ray& ray, std::size_t point) {
    rays_[n_] = ray;
    points_[n_++] = point;
    if (n_ == RayCaster::kPacket) cast();
  }
  /// Marks the points that are seen.
  void cast() {
    if (n_ == 0) return;
    std::array<std::uint8_t, RayCaster::kPacket> blocked;
    caster_.are_blocked(std::span(rays_).first(n_), blocked);
    for (std::size_t k = 0; k < n_; ++k) seen_[points_[k]] = blocked[k] == 0 ? 1 : 0;
    n_ = 0;
  }

 private:
  const RayCaster& caster_;
  std::span<std::uint8_t> seen_;
  std::array<Ray, RayCaster::kPacket> rays_;
  std::array<std::size_t, RayCaster::kPacket> points_;
  std::size_t n_ = 0;
};

/// The views to which some of the points may be near enough, nearest first: those are the likeliest to see them.
std::vector<const SeenFrom*> views_near(const std::vector<SeenFrom>& views, std::span<const Eigen::Vector3f> points,
                                        double max_distance_m) {
  const Eigen::Vector3d middle = points.front().cast<double>();
  double reach = max_distance_m;
  for (const Eigen::Vector3f& p : points) {
    reach = std::max(reach, max_distance_m + kTolerance_m + (p.cast<double>() - middle).norm());
  }
  std::vector<std::pair<double, const SeenFrom*>> near;
  for (const SeenFrom& view : views) {
    const double distance = (view.center - middle).norm();
    if (distance <= reach) near.emplace_back(distance, &view);
  }
  std::ranges::stable_sort(near, {}, &std::pair<double, const SeenFrom*>::first);
  std::vector<const SeenFrom*> sorted;
  for (const auto& [distance, view] : near) sorted.push_back(view);
  return sorted;
}

/// 1 for each point that a view sees. View by view: rays from one camera to neighboring points are cast fast.
Array<std::uint8_t> seen_by_any(const SceneData& scene, const CameraModel& camera, const std::vector<SeenFrom>& views,
                                std::span<const Eigen::Vector3f> points, double max_distance_m) {
  Array<std::uint8_t> seen(points.size(), 0);
  parallel_chunks(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    const auto chunk = points.subspan(begin, end - begin);
    RayPacket packet(scene.caster, std::span(seen).subspan(begin, end - begin));
    for (const SeenFrom* view : views_near(views, chunk, max_distance_m)) {
      for (std::size_t i = 0; i < chunk.size(); ++i) {
        if (seen[begin + i] != 0) continue;
        const auto ray = ray_to(chunk[i].cast<double>(), *view, scene.mesh.origin, camera, max_distance_m);
        if (ray) packet.add(*ray, i);
      }
      packet.cast();
    }
  });
  return seen;
}

}  // namespace

PointCloud seen_surface(const Scene& scene, const CameraModel& camera,
                        std::span<const Eigen::Isometry3d> T_world_camera, const SeenSurfaceOptions& options) {
  check(camera);
  require_between("max_distance_m", options.max_distance_m, 1e-3, 1e6);
  const SceneData& data = scene.data();
  std::vector<SeenFrom> views;
  for (const Eigen::Isometry3d& pose : T_world_camera) {
    views.push_back({pose.inverse(), pose.translation() - data.mesh.origin});
  }
  const SurfaceSamples all = draw_samples(data, options.points_per_m2, options.seed);
  const Array<std::uint8_t> seen = seen_by_any(data, camera, views, all.positions, options.max_distance_m);
  SurfaceSamples kept;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] == 0) continue;
    kept.positions.push_back(all.positions[i]);
    kept.triangles.push_back(all.triangles[i]);
  }
  return colored(data, std::move(kept));
}

}  // namespace cmap
