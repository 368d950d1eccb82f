#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

#include "cmap/core/error.hpp"

namespace cmap {

/// How a recording puts its messages into bytes.
enum class MessageEncoding { kRos1, kCdr, kOther };

/// std_msgs/Header.
struct MessageHeader {
  std::uint32_t sequence = 0;  ///< 0 in CDR, which has none
  std::int64_t stamp_ns = 0;
  double stamp_s() const;
};

/// The values of a message in their order: the serialization of ROS 1, which is packed, or CDR as ROS 2 writes it (four
/// bytes that say how; every number at a multiple of its size). Whatever does not fit is an InputError that names the
/// byte; which file and message it is, the caller adds.
class WireReader {
 public:
  WireReader(MessageEncoding encoding, std::span<const std::byte> message);

  bool is_ros1() const { return is_ros1_; }
  bool is_swapped() const { return is_swapped_; }
  std::size_t remaining() const { return bytes_.size() - position_; }

  template <class T>
  T number() {
    align(sizeof(T));
    const std::span<const std::byte> place = bytes(sizeof(T));
    std::array<std::byte, sizeof(T)> raw;
    std::memcpy(raw.data(), place.data(), sizeof(T));
    if (is_swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  /// Steps over an array of fixed length.
  template <class T>
  void skip(std::size_t n) {
    if (n > 0) align(sizeof(T));
    bytes(n * sizeof(T));
  }
  /// To a multiple of `size`, in CDR.
  void align(std::size_t size) {
    if (!is_ros1_) bytes((size - (position_ - kEncapsulation) % size) % size);
  }
  std::span<const std::byte> bytes(std::size_t n);
  std::string_view text();
  /// The length of a sequence whose elements take at least so many bytes each.
  std::uint32_t count(std::size_t least_bytes);
  /// A sequence of bytes.
  std::span<const std::byte> blob() { return bytes(count(1)); }
  std::int64_t time_ns();
  MessageHeader header();
  /// From here on the stamp of a header, whatever it says.
  void replace_stamp(std::int64_t stamp_ns) { stamp_ns_ = stamp_ns; }

  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> reason, Args&&... args) const {
    throw InputError(fmt::format("byte {}: ", position_) + fmt::format(reason, std::forward<Args>(args)...));
  }

 private:
  static constexpr std::size_t kEncapsulation = 4;

  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
  bool is_ros1_ = true;
  bool is_swapped_ = false;
  std::optional<std::int64_t> stamp_ns_;
};

}  // namespace cmap
