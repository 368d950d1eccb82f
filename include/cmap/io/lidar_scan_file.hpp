#pragma once

#include <filesystem>

#include "cmap/geometry/lidar_scan.hpp"

namespace cmap {

/// Reads a PCD file (ascii, binary, compressed) with x y z and, by these names, intensity, time and ring; other fields
/// are stepped over. Points whose position, time or intensity is not finite are dropped; none left is an empty scan, as
/// a sensor that saw only sky gives it. Thread-safe. Throws InputError naming file, place and reason: malformed or
/// truncated, no x y z, a time further than 60 s from the scan's (nanoseconds?), a ring that fits no 16 bits. Also
/// reads velodyne_points/data/NUMBER.bin of a KITTI drive, points' times by their azimuth (FORMATS, "KITTI drives").
LidarScan read_lidar_scan(const std::filesystem::path& path, double timestamp_s);

/// Writes a binary PCD file with the arrays that the scan has. Throws OutputError if it cannot be written,
/// std::invalid_argument if an array has another length.
void write_lidar_scan(const LidarScan& scan, const std::filesystem::path& path);

}  // namespace cmap
