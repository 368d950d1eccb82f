#pragma once

#include <Eigen/Geometry>
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

/// From the first pose to the last; there must be one.
inline double duration_s(const Trajectory& trajectory) { return trajectory.back().time_s - trajectory.front().time_s; }

}  // namespace cmap
