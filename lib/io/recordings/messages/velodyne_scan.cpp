#include "recordings/messages/velodyne_scan.hpp"

#include <cmath>
#include <numbers>

#include "bytes/little_endian.hpp"

namespace cmap {
namespace {

constexpr std::size_t kPacketBytes = 1206, kBlocks = 12, kBlockBytes = 100, kFirings = 2, kLasers = 16;
constexpr std::size_t kReturnMode = 1204, kProduct = 1205;
constexpr unsigned kDual = 0x39, kVlp16 = 0x22;
constexpr int kTurn_cdeg = 36000;
constexpr double kLaser_s = 2.304e-6, kFiring_s = 55.296e-6, kDistanceUnit_m = 0.002;

/// Degrees, in the order in which lasers fire: -15, 1, -13, 3, ...
double elevation_deg(std::size_t laser) {
  return laser % 2 == 0 ? -15.0 + static_cast<double>(laser) : static_cast<double>(laser);
}
std::uint16_t ring_of(std::size_t laser) {
  return static_cast<std::uint16_t>(laser / 2 + (laser % 2 == 0 ? 0 : kLasers / 2));
}

struct Packet {
  std::span<const std::byte> bytes;
  double time_s;  ///< from the scan's stamp

  std::size_t returns() const { return std::to_integer<unsigned>(bytes[kReturnMode]) == kDual ? 2 : 1; }
  int azimuth_cdeg(std::size_t block) const { return load_little<std::uint16_t>(bytes, block * kBlockBytes + 2); }
  std::size_t place(std::size_t block, std::size_t shot) const { return block * kBlockBytes + 4 + 3 * shot; }
  std::uint16_t distance(std::size_t block, std::size_t shot) const {
    return load_little<std::uint16_t>(bytes, place(block, shot));
  }
  std::uint8_t intensity(std::size_t block, std::size_t shot) const {
    return std::to_integer<std::uint8_t>(bytes[place(block, shot) + 2]);
  }
  /// What the head turns from this block's firing to the next one's; the last takes that of the one before.
  int turned_cdeg(std::size_t block) const {
    const std::size_t from = block + returns() < kBlocks ? block : block - returns();
    return (azimuth_cdeg(from + returns()) - azimuth_cdeg(from) + kTurn_cdeg) % kTurn_cdeg;
  }
};

void check_packet(const WireReader& reader, std::span<const std::byte> bytes) {
  const auto product = std::to_integer<unsigned>(bytes[kProduct]);
  if (product != kVlp16) {
    throw UnsupportedError(
        fmt::format("packets of a Velodyne sensor 0x{:02x}; those of a VLP-16 (0x22) are understood. The "
                    "driver's sensor_msgs/PointCloud2 is read of every sensor",
                    product));
  }
  for (std::size_t block = 0; block < kBlocks; ++block) {
    if (load_little<std::uint16_t>(bytes, block * kBlockBytes) != 0xEEFF) reader.fail("a block without its flag");
  }
}

void add_shot(const Packet& packet, std::size_t block, std::size_t shot, LidarScan& scan) {
  const std::uint16_t distance = packet.distance(block, shot);
  if (distance == 0) return;  // no return
  const std::size_t laser = shot % kLasers;
  const double after_s = kFiring_s * static_cast<double>(shot / kLasers) + kLaser_s * static_cast<double>(laser);
  const double azimuth_cdeg =
      packet.azimuth_cdeg(block) + packet.turned_cdeg(block) * after_s / (kFiring_s * static_cast<double>(kFirings));
  constexpr double kDegree = std::numbers::pi / 180.0;
  const double azimuth = 0.01 * azimuth_cdeg * kDegree, elevation = elevation_deg(laser) * kDegree;
  const double range_m = kDistanceUnit_m * distance, level_m = range_m * std::cos(elevation);
  scan.positions.push_back(
      Eigen::Vector3d(level_m * std::cos(azimuth), -level_m * std::sin(azimuth), range_m * std::sin(elevation))
          .cast<float>());
  scan.intensity.push_back(packet.intensity(block, shot));
  scan.time_s.push_back(static_cast<float>(packet.time_s + after_s +
                                           kFiring_s * static_cast<double>(kFirings * (block / packet.returns()))));
  scan.ring.push_back(ring_of(laser));
}

void add_packet(const Packet& packet, LidarScan& scan) {
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const bool is_second = packet.returns() == 2 && block % 2 == 1;
    for (std::size_t shot = 0; shot < kFirings * kLasers; ++shot) {
      if (is_second && packet.distance(block, shot) == packet.distance(block - 1, shot)) continue;
      add_shot(packet, block, shot, scan);
    }
  }
}

}  // namespace

LidarScan read_velodyne_scan(WireReader& reader) {
  LidarScan scan;
  const MessageHeader header = reader.header();
  scan.timestamp_s = header.stamp_s();
  const std::uint32_t n = reader.count(8 + kPacketBytes);
  scan.positions.reserve(std::size_t{n} * kBlocks * kFirings * kLasers);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::int64_t stamp_ns = reader.time_ns();
    const std::span<const std::byte> bytes = reader.bytes(kPacketBytes);
    check_packet(reader, bytes);
    add_packet({bytes, 1e-9 * static_cast<double>(stamp_ns - header.stamp_ns)}, scan);
  }
  return scan;
}

}  // namespace cmap
