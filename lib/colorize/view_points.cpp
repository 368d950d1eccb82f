// Which discs a camera has before it.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "cmap/colorize/depth_buffer.hpp"
#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

constexpr double kMargin = 0.1;         ///< of the image's size, around it
constexpr std::size_t kGroupChunk = 8;  ///< groups in a task

/// Largest angle between the optical axis and what an image, with its margin, shows; rad.
double widest_angle(const CameraModel& camera) {
  if (camera.projection == CameraProjection::kFisheye) return std::numbers::pi;
  const double x = std::max(camera.cx, camera.width - camera.cx) + kMargin * camera.width;
  const double y = std::max(camera.cy, camera.height - camera.cy) + kMargin * camera.height;
  // Barrel distortion shows more than the undistorted image would.
  const double distortion = camera.distortion.empty() ? 1.0 : 2.0;
  return std::atan(distortion * std::hypot(x / camera.fx, y / camera.fy));
}

bool may_be_seen(const Eigen::Vector3d& center, double radius, double widest, double max_range_m) {
  const double distance = center.norm();
  if (distance - radius > max_range_m) return false;
  if (distance <= radius) return true;
  return std::acos(std::clamp(center.z() / distance, -1.0, 1.0)) - std::asin(radius / distance) <= widest;
}

bool is_near(const CameraModel& camera, const Eigen::Vector2d& pixel) {
  const double x = kMargin * camera.width, y = kMargin * camera.height;
  return pixel.x() >= -x && pixel.y() >= -y && pixel.x() <= camera.width + x && pixel.y() <= camera.height + y;
}

}  // namespace

Array<ViewPoint> points_in_view(const Surfels& surfels, const CameraModel& camera,
                                const Eigen::Isometry3d& T_camera_world, const OcclusionOptions& options) {
  const Eigen::Matrix3d R = T_camera_world.linear();
  const Eigen::Vector3d t = T_camera_world * surfels.origin;
  const double widest = widest_angle(camera);
  std::vector<std::size_t> groups;
  for (std::size_t g = 0; g < surfels.groups.size(); ++g) {
    const SurfelGroup& group = surfels.groups[g];
    const auto radius = static_cast<double>(group.radius_m);
    if (may_be_seen(R * group.center.cast<double>() + t, radius, widest, options.max_range_m)) groups.push_back(g);
  }

  std::vector<Array<ViewPoint>> parts((groups.size() + kGroupChunk - 1) / kGroupChunk);
  const auto add = [&](std::size_t slot, Array<ViewPoint>& part) {
    const Eigen::Vector3d p = R * surfels.positions[slot].cast<double>() + t;
    const double range = p.norm();
    if (!(range <= options.max_range_m)) return;
    const auto pixel = project(camera, p);
    if (!pixel || !is_near(camera, *pixel)) return;
    ViewPoint point;
    point.slot = static_cast<std::uint32_t>(slot);
    point.radius_m = surfels.radius_m[slot];
    point.position = p.cast<float>();
    point.normal = (R * surfels.normals[slot].cast<double>()).cast<float>();
    point.range_m = static_cast<float>(range);
    point.pixel = pixel->cast<float>();
    point.is_inside = is_inside(camera, *pixel);
    part.push_back(point);
  };
  parallel_chunks(groups.size(), kGroupChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      const std::size_t first = groups[g] * Surfels::kGroup;
      for (std::size_t slot = first; slot < std::min(surfels.size(), first + Surfels::kGroup); ++slot) {
        add(slot, parts[begin / kGroupChunk]);
      }
    }
  });
  Array<ViewPoint> points;
  for (const Array<ViewPoint>& part : parts) points.insert(points.end(), part.begin(), part.end());
  return points;
}

}  // namespace cmap
