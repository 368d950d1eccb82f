#pragma once

#include <filesystem>

#include "cmap/geometry/lidar_scan.hpp"

namespace cmap {

/// Whether a scan is one of a drive of KITTI's raw data: velodyne_points/data/NUMBER.bin, or .txt in drives
/// that are not synchronized.
bool is_kitti_scan(const std::filesystem::path& path);

/// x y z intensity of each point, and its time by the direction it lies in, as none is recorded: seen from above the
/// HDL-64E turns clockwise, and its turn begins and ends behind the car, from timestamps_start.txt to
/// timestamps_end.txt. (Seen by planes ten scans apart: 2.8 cm, 9.6 without times, 17 with the other direction.) Throws
/// InputError naming file, place and reason.
LidarScan read_kitti_scan(const std::filesystem::path& path, double timestamp_s);

}  // namespace cmap
