#pragma once

#include <Eigen/Geometry>

#include "cmap/core/array.hpp"

namespace cmap {

/// What an odometry saw from one place.
struct Keyframe {
  double time_s = 0.0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();  ///< at time_s; world z is up
  Array<Eigen::Vector3f> points_body;                              ///< m, undistorted, in the body's axes at time_s
};

}  // namespace cmap
