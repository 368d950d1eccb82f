#include <cmath>

#include "recordings/messages/cloud_columns.hpp"
#include "recordings/messages/livox_tag.hpp"

namespace cmap {
namespace {

bool is_finite(float value) { return (std::bit_cast<std::uint32_t>(value) & 0x7F800000U) != 0x7F800000U; }

/// A scan as it stands in the message, and which points are none.
struct Columns {
  LidarScan scan;
  Array<std::uint8_t> left_out;  ///< empty: none
  void leave_out(std::size_t i) {
    if (left_out.empty()) left_out.assign(scan.positions.size(), 0);
    left_out[i] = 1;
  }
};

bool is_plain_xyz(const PointCloud2& cloud, const std::array<const CloudField*, 3>& axes) {
  if (cloud.is_big_endian != (std::endian::native == std::endian::big)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (axes[k]->type != ScalarType::kFloat32 || axes[k]->offset != axes[0]->offset + 4 * k) return false;
  }
  return true;
}

void read_positions(const PointCloud2& cloud, Columns& columns) {
  const std::array<const CloudField*, 3> axes{cloud.find({"x"}), cloud.find({"y"}), cloud.find({"z"})};
  for (std::size_t k = 0; k < 3; ++k) {
    if (axes[k] == nullptr) throw InputError(fmt::format("points have no field '{}'", "xyz"[k]));
  }
  Array<Eigen::Vector3f>& positions = columns.scan.positions;
  positions.resize(cloud.n_points());
  if (is_plain_xyz(cloud, axes)) {
    for_each_run(cloud, [&](const std::byte* first, std::size_t n, std::size_t begin) {
      const std::byte* place = first + axes[0]->offset;
      for (std::size_t i = 0; i < n; ++i, place += cloud.point_step) {
        std::memcpy(positions[begin + i].data(), place, sizeof(Eigen::Vector3f));
      }
    });
  } else {
    for (int k = 0; k < 3; ++k) {
      for_each_number(cloud, *axes[static_cast<std::size_t>(k)],
                      [&](std::size_t i, auto value) { positions[i][k] = static_cast<float>(value); });
    }
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3f& p = positions[i];
    if (!(is_finite(p.x()) && is_finite(p.y()) && is_finite(p.z()))) columns.leave_out(i);
  }
}

void read_intensity(const PointCloud2& cloud, Columns& columns) {
  const CloudField* field = cloud.find({"intensity", "reflectivity", "i"});
  if (field == nullptr) return;
  columns.scan.intensity.resize(cloud.n_points());
  for_each_number(cloud, *field, [&](std::size_t i, auto value) {
    const auto intensity = static_cast<float>(value);
    if (!is_finite(intensity)) columns.leave_out(i);
    columns.scan.intensity[i] = intensity;
  });
}

void read_times(const PointCloud2& cloud, PointTimes& times, Columns& columns) {
  const CloudField* field = cloud.find(
      {"time", "t", "timestamp", "time_stamp", "offset_time", "time_offset", "point_time_offset", "t_us", "time_us"});
  if (field == nullptr) return;
  Array<double> values(cloud.n_points());
  for_each_number(cloud, *field, [&](std::size_t i, auto value) { values[i] = static_cast<double>(value); });
  // Times of points that are none are of no account.
  for (std::size_t i = 0; i < columns.left_out.size(); ++i) {
    if (columns.left_out[i] != 0) values[i] = std::nan("");
  }
  times.to_offsets(values, field->name, field->type, cloud.header.stamp_ns);
  columns.scan.time_s.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto time_s = static_cast<float>(values[i]);
    if (!is_finite(time_s)) columns.leave_out(i);
    columns.scan.time_s[i] = time_s;
  }
}

void read_rings(const PointCloud2& cloud, Columns& columns) {
  const CloudField* field = cloud.find({"ring", "channel", "line", "laser_id"});
  if (field == nullptr || is_floating(field->type)) return;
  columns.scan.ring.resize(cloud.n_points());
  for_each_number(cloud, *field,
                  [&](std::size_t i, auto value) { columns.scan.ring[i] = static_cast<std::uint16_t>(value); });
}

void read_tags(const PointCloud2& cloud, Columns& columns) {
  const CloudField* field = cloud.find({"tag"});
  if (field == nullptr || field->type != ScalarType::kUint8 || cloud.find({"line"}) == nullptr) return;
  for_each_number(cloud, *field, [&](std::size_t i, auto value) {
    if (!is_livox_point(static_cast<std::uint8_t>(value))) columns.leave_out(i);
  });
}

template <class T>
void keep(const Array<std::uint8_t>& left_out, Array<T>& values) {
  if (values.empty()) return;
  std::size_t n = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (left_out[i] == 0) values[n++] = values[i];
  }
  values.resize(n);
}

}  // namespace

LidarScan scan_of(const PointCloud2& cloud, PointTimes& times) {
  Columns columns;
  columns.scan.timestamp_s = cloud.header.stamp_s();
  if (cloud.n_points() == 0) return columns.scan;
  read_positions(cloud, columns);
  read_tags(cloud, columns);
  read_intensity(cloud, columns);
  read_times(cloud, times, columns);
  read_rings(cloud, columns);
  if (!columns.left_out.empty()) {
    keep(columns.left_out, columns.scan.positions);
    keep(columns.left_out, columns.scan.intensity);
    keep(columns.left_out, columns.scan.time_s);
    keep(columns.left_out, columns.scan.ring);
  }
  return std::move(columns.scan);
}

}  // namespace cmap
