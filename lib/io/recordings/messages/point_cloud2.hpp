#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cmap/geometry/lidar_scan.hpp"
#include "recordings/messages/point_times.hpp"
#include "recordings/wire/wire_reader.hpp"

namespace cmap {

/// sensor_msgs/PointField of one number.
struct CloudField {
  std::string name;
  std::uint32_t offset = 0;
  ScalarType type = ScalarType::kFloat32;
};

/// sensor_msgs/PointCloud2, its layout checked: every point and field lies inside `data`.
struct PointCloud2 {
  MessageHeader header;
  std::uint32_t height = 0, width = 0;
  std::vector<CloudField> fields;
  bool is_big_endian = false;
  std::uint32_t point_step = 0;
  std::size_t row_step = 0;
  std::span<const std::byte> data;

  std::size_t n_points() const { return std::size_t{height} * width; }
  /// The first of some names; none: nullptr.
  const CloudField* find(std::initializer_list<std::string_view> names) const;
};

PointCloud2 read_point_cloud2(WireReader& reader);

/// Position, intensity, time and ring of each point. Points whose position, time or intensity is no number are left out
/// with all that belongs to them, as are Livox' noise points (fields tag and line).
LidarScan scan_of(const PointCloud2& cloud, PointTimes& times);

}  // namespace cmap
