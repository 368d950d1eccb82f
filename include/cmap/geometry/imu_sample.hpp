#pragma once

#include <Eigen/Core>

namespace cmap {

inline constexpr double kStandardGravity_mps2 = 9.80665;

/// One measurement of an IMU, in its own frame.
struct ImuSample {
  double time_s = 0.0;
  Eigen::Vector3d angular_rate_radps;
  Eigen::Vector3d specific_force_mps2;  ///< at rest: 9.8 m/s^2 upward
};

}  // namespace cmap
