#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "cmap/core/array.hpp"

namespace cmap {

/// One scan, every point in the LiDAR frame at the point's own time. Optional arrays are as long as positions or empty.
struct LidarScan {
  double timestamp_s = 0.0;
  Array<Eigen::Vector3f> positions;  ///< m
  Array<float> intensity;            ///< as the sensor gives it
  Array<float> time_s;               ///< from timestamp_s; empty: motion-compensated at timestamp_s
  Array<std::uint16_t> ring;         ///< channel of the sensor
};

}  // namespace cmap
