#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "cmap/align/trajectory.hpp"

namespace cmap {

/// How the camera sits on the body whose poses a trajectory holds.
struct CameraMount {
  Eigen::Isometry3d T_imu_lidar = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_lidar_camera = Eigen::Isometry3d::Identity();
};

/// Which pose of the body goes with an image.
enum class PosePairing {
  kInterpolated,  ///< at the image's stamp: pose_at()
  kNearest,       ///< the paper's: the one nearest in time, the earlier of two; at 12 m/s and 10 Hz up to 0.6 m off
};

/// Where a trajectory has the cameras of a session's frames; none where it has no pose.
using OdometryPoses = std::vector<std::optional<Eigen::Isometry3d>>;

/// T_world_camera at the images' stamps, from world_T_imu poses; none where the poses around a stamp are more than
/// max_gap_s apart, or the nearest is farther than that. Thread-safe.
OdometryPoses camera_poses(const Trajectory& world_T_imu, const CameraMount& mount,
                           std::span<const double> image_times_s, PosePairing pairing, double max_gap_s = 0.15);

}  // namespace cmap
