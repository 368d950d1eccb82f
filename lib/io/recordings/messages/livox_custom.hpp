#pragma once

#include "cmap/geometry/lidar_scan.hpp"
#include "recordings/wire/wire_reader.hpp"

namespace cmap {

/// CustomMsg of livox_ros_driver, livox_ros_driver2 and livox_interfaces. A point's time is timebase + offset_time,
/// both in nanoseconds; where the timebase is of another clock than the stamp, it is taken for the stamp. Noise points
/// (by tag), and points whose position is no number, are left out. The ring is Livox' line.
LidarScan read_livox_custom(WireReader& reader);

}  // namespace cmap
