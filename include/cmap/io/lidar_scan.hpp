#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "cmap/core/array.hpp"

namespace cmap {

/// One scan in the LiDAR frame.
struct LidarScan {
  double timestamp_s = 0.0;
  Array<Eigen::Vector3f> positions;  ///< m, LiDAR frame at each point's own time
  Array<float> intensity;            ///< as the sensor gives it; empty: none
  Array<float> time_s;               ///< from timestamp_s; empty: motion-compensated at timestamp_s
  Array<std::uint16_t> ring;         ///< empty: none
};

}  // namespace cmap
