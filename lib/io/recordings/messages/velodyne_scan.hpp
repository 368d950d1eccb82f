#pragma once

#include "cmap/geometry/lidar_scan.hpp"
#include "recordings/wire/wire_reader.hpp"

namespace cmap {

/// velodyne_msgs/VelodyneScan: the packets of one turn of a VLP-16 (Velodyne 63-9243, section 9), with ROS' axes: x is
/// azimuth 0, y to its left. Times from the stamp are those of packets plus those of lasers within. Rings count from
/// the lowest laser. Of a dual return both are given where they differ. Other sensors are an UnsupportedError.
LidarScan read_velodyne_scan(WireReader& reader);

}  // namespace cmap
