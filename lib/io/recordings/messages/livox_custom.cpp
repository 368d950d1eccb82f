#include "recordings/messages/livox_custom.hpp"

#include <cstdlib>

#include "recordings/messages/livox_tag.hpp"

namespace cmap {
namespace {

/// From stamp to timebase; 0 where they are of different clocks.
std::int64_t timebase_offset_ns(std::int64_t stamp_ns, std::uint64_t timebase_ns) {
  constexpr std::int64_t kNear_ns = 1'000'000'000;
  const auto offset_ns = static_cast<std::int64_t>(timebase_ns - static_cast<std::uint64_t>(stamp_ns));
  return offset_ns > -kNear_ns && offset_ns < kNear_ns ? offset_ns : 0;
}

}  // namespace

LidarScan read_livox_custom(WireReader& reader) {
  LidarScan scan;
  const MessageHeader header = reader.header();
  scan.timestamp_s = header.stamp_s();
  const std::int64_t base_ns = timebase_offset_ns(header.stamp_ns, reader.number<std::uint64_t>());
  const auto declared = reader.number<std::uint32_t>();
  reader.skip<std::uint8_t>(4);  // lidar_id, rsvd
  constexpr std::size_t kPointBytes = 19;
  const std::uint32_t n = reader.count(kPointBytes);
  if (n != declared) reader.fail("{} points, but point_num is {}", n, declared);
  scan.positions.reserve(n);
  scan.intensity.reserve(n);
  scan.time_s.reserve(n);
  scan.ring.reserve(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto offset_ns = reader.number<std::uint32_t>();
    const auto x = reader.number<float>(), y = reader.number<float>(), z = reader.number<float>();
    const auto reflectivity = reader.number<std::uint8_t>(), tag = reader.number<std::uint8_t>();
    const auto line = reader.number<std::uint8_t>();
    const Eigen::Vector3f position(x, y, z);
    if (!is_livox_point(tag) || !position.allFinite()) continue;
    scan.positions.push_back(position);
    scan.intensity.push_back(static_cast<float>(reflectivity));
    scan.time_s.push_back(static_cast<float>(1e-9 * static_cast<double>(base_ns + offset_ns)));
    scan.ring.push_back(line);
  }
  return scan;
}

}  // namespace cmap
