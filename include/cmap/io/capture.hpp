#pragma once

#include <Eigen/Core>

namespace cmap {

struct ImuSample {
  double time_s = 0.0;
  Eigen::Vector3d angular_rate_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
};

}  // namespace cmap
