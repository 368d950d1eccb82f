#include "cmap/recon/camera_poses.hpp"

#include <algorithm>
#include <cmath>

namespace cmap {
namespace {

std::optional<StampedPose> nearest_pose(const Trajectory& trajectory, double time_s, double max_gap_s) {
  const auto after = std::ranges::lower_bound(trajectory, time_s, {}, &StampedPose::time_s);
  auto nearest = after;
  if (after == trajectory.end() ||
      (after != trajectory.begin() && time_s - std::prev(after)->time_s <= after->time_s - time_s)) {
    if (after == trajectory.begin()) return std::nullopt;
    nearest = std::prev(after);
  }
  if (std::abs(nearest->time_s - time_s) > max_gap_s) return std::nullopt;
  return *nearest;
}

}  // namespace

OdometryPoses camera_poses(const Trajectory& world_T_imu, const CameraMount& mount,
                           std::span<const double> image_times_s, PosePairing pairing, double max_gap_s) {
  const Eigen::Isometry3d T_imu_camera = mount.T_imu_lidar * mount.T_lidar_camera;
  OdometryPoses poses;
  for (const double time_s : image_times_s) {
    const auto body = pairing == PosePairing::kNearest ? nearest_pose(world_T_imu, time_s, max_gap_s)
                                                       : pose_at(world_T_imu, time_s, max_gap_s);
    poses.emplace_back();
    if (body) poses.back() = Eigen::Translation3d(body->position) * body->rotation * T_imu_camera;
  }
  return poses;
}

}  // namespace cmap
