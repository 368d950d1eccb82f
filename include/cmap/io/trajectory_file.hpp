#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

namespace cmap {

/// Where something was at one time: x_world = rotation x_body + position.
struct StampedPose {
  double time_s = 0.0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// Poses by increasing time.
using Trajectory = std::vector<StampedPose>;

/// Reads a TUM file: lines "time x y z qx qy qz qw", separated by blanks or commas, `#` comments; quaternions of any
/// length are normalized. Throws InputError naming file, line and reason: not eight finite numbers, a quaternion of
/// zero, a time that is not after the one before, no pose at all.
Trajectory read_tum_trajectory(const std::filesystem::path& path);

}  // namespace cmap
