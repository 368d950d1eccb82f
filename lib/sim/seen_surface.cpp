#include "sim/seen_surface.hpp"

#include <cmath>

#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

/// Whether the point is about as near as the middle of its pixel: most that is hidden is told by this, without a ray.
bool may_be_shown(const CameraModel& camera, const Eigen::Vector3d& p, const Array<float>& depth_m) {
  constexpr double kSlack_m = 0.3, kSlackFraction = 0.05;
  const std::optional<Eigen::Vector2d> pixel = project(camera, p);
  if (!pixel || !is_inside(camera, *pixel)) return false;
  const auto u = static_cast<std::size_t>(std::clamp<long>(std::lround(pixel->x()), 0, camera.width - 1));
  const auto v = static_cast<std::size_t>(std::clamp<long>(std::lround(pixel->y()), 0, camera.height - 1));
  const double front = depth_m[v * static_cast<std::size_t>(camera.width) + u];
  return p.z() <= front * (1.0 + kSlackFraction) + kSlack_m;
}

}  // namespace

bool SeenSurface::is_reached(const Eigen::Vector3d& camera, const Eigen::Vector3d& point) const {
  constexpr double kSlack_m = 0.01;  // float positions on surfaces seen at a slant
  const Eigen::Vector3d way = point - camera;
  const double distance = way.norm();
  return !scene_.probe(camera, way / distance, distance - kSlack_m);
}

void SeenSurface::look(const CameraModel& camera, const Eigen::Isometry3d& T_world_camera, const Array<float>& depth_m,
                       double max_depth_m) {
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  parallel_chunks(samples_.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (seen_[i] != 0) continue;
      const Eigen::Vector3d p = T_camera_world * samples_.world(i);
      if (!(p.z() > 0.0 && p.z() <= max_depth_m) || !may_be_shown(camera, p, depth_m)) continue;
      if (is_reached(T_world_camera.translation(), samples_.world(i))) seen_[i] = 1;
    }
  });
}

}  // namespace cmap
