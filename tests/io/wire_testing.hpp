#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/geometry/lidar_scan.hpp"
#include "recordings/wire/wire_reader.hpp"

namespace cmap::testing {

/// Ways in which a message can be put into bytes.
enum class Wire { kRos1, kCdrLittle, kCdrBig };
inline constexpr std::array kWires{Wire::kRos1, Wire::kCdrLittle, Wire::kCdrBig};
inline MessageEncoding encoding_of(Wire wire) {
  return wire == Wire::kRos1 ? MessageEncoding::kRos1 : MessageEncoding::kCdr;
}

/// Puts a message together by hand.
class WireWriter {
 public:
  explicit WireWriter(Wire wire) : wire_(wire) {
    if (wire == Wire::kCdrLittle) bytes_ = std::string("\0\1\0\0", 4);
    if (wire == Wire::kCdrBig) bytes_ = std::string("\0\0\0\0", 4);
  }

  template <class T>
  WireWriter& put(T value) {
    align(sizeof(T));
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if (wire_ == Wire::kCdrBig) std::reverse(raw.begin(), raw.end());
    bytes_.append(raw.data(), raw.size());
    return *this;
  }
  template <class T>
  WireWriter& zeros(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) put(T{});
    return *this;
  }
  WireWriter& text(std::string_view text) {
    const std::string ended = std::string(text) + (wire_ == Wire::kRos1 ? "" : std::string(1, '\0'));
    return blob(ended);
  }
  WireWriter& blob(std::string_view bytes) {
    put(static_cast<std::uint32_t>(bytes.size()));
    bytes_ += bytes;
    return *this;
  }
  WireWriter& raw(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }
  WireWriter& header(std::uint32_t sequence, std::uint32_t seconds, std::uint32_t nanoseconds) {
    if (wire_ == Wire::kRos1) put(sequence);
    return put(seconds).put(nanoseconds).text("frame");
  }
  void align(std::size_t size) {
    if (wire_ == Wire::kRos1) return;
    while ((bytes_.size() - 4) % size != 0) bytes_ += '\0';
  }
  Wire wire() const { return wire_; }
  const std::string& str() const { return bytes_; }

 private:
  Wire wire_;
  std::string bytes_;
};

inline std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

/// A field of a cloud: name, byte in the point, datatype of sensor_msgs/PointField.
struct FieldText {
  std::string name;
  std::uint32_t offset;
  std::uint8_t datatype;
};
inline constexpr std::uint8_t kPointUint8 = 2, kPointUint16 = 4, kPointUint32 = 6, kPointFloat32 = 7, kPointFloat64 = 8;

struct CloudText {
  std::uint32_t height = 1, width = 0;
  std::vector<FieldText> fields;
  bool big_endian = false;
  std::uint32_t point_step = 0, row_step = 0;
  std::string data;
};

inline std::string point_cloud2(Wire wire, const CloudText& cloud, std::uint32_t seconds = 100,
                                std::uint32_t nanoseconds = 500'000'000) {
  WireWriter writer(wire);
  writer.header(7, seconds, nanoseconds).put(cloud.height).put(cloud.width);
  writer.put(static_cast<std::uint32_t>(cloud.fields.size()));
  for (const FieldText& field : cloud.fields) {
    writer.text(field.name).put(field.offset).put(field.datatype).put(std::uint32_t{1});
  }
  writer.put(static_cast<std::uint8_t>(cloud.big_endian)).put(cloud.point_step).put(cloud.row_step);
  writer.blob(cloud.data).put(std::uint8_t{0});
  return writer.str();
}

inline std::string imu_message(Wire wire, double ax, double ay, double az, std::uint32_t sequence = 0,
                               std::uint32_t seconds = 100, std::uint32_t nanoseconds = 0) {
  WireWriter writer(wire);
  writer.header(sequence, seconds, nanoseconds).zeros<double>(4 + 9);
  writer.put(0.1).put(0.2).put(0.3).zeros<double>(9).put(ax).put(ay).put(az).zeros<double>(9);
  return writer.str();
}

}  // namespace cmap::testing
