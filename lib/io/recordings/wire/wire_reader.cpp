#include "recordings/wire/wire_reader.hpp"

namespace cmap {

double MessageHeader::stamp_s() const {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  return static_cast<double>(stamp_ns / kNanosecondsPerSecond) +
         1e-9 * static_cast<double>(stamp_ns % kNanosecondsPerSecond);
}

WireReader::WireReader(MessageEncoding encoding, std::span<const std::byte> message)
    : bytes_(message), is_ros1_(encoding == MessageEncoding::kRos1) {
  if (is_ros1_) {
    is_swapped_ = std::endian::native == std::endian::big;
    return;
  }
  const std::span<const std::byte> start = bytes(kEncapsulation);
  const auto kind = std::to_integer<unsigned>(start[0]) << 8 | std::to_integer<unsigned>(start[1]);
  // RTPS: 0 is CDR, big endian, 1 little endian; what follows are parameter lists and the second version of CDR.
  if (kind > 1) fail("CDR of kind 0x{:04x}; 0x0000 or 0x0001 (plain CDR) expected", kind);
  is_swapped_ = (kind == 1) == (std::endian::native == std::endian::big);
}

std::span<const std::byte> WireReader::bytes(std::size_t n) {
  if (n > remaining()) fail("cut off: {} bytes expected, {} are left", n, remaining());
  const std::span<const std::byte> found = bytes_.subspan(position_, n);
  position_ += n;
  return found;
}

std::string_view WireReader::text() {
  const std::span<const std::byte> found = blob();
  std::string_view text(reinterpret_cast<const char*>(found.data()), found.size());
  // CDR counts the zero at the end.
  if (!is_ros1_ && text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

std::uint32_t WireReader::count(std::size_t least_bytes) {
  const auto n = number<std::uint32_t>();
  if (n > remaining() / least_bytes) {
    fail("{} elements of {} bytes or more do not fit into the {} that are left", n, least_bytes, remaining());
  }
  return n;
}

std::int64_t WireReader::time_ns() {
  // Seconds are unsigned in ROS 1, signed in ROS 2.
  const auto seconds = number<std::uint32_t>();
  const auto nanoseconds = number<std::uint32_t>();
  constexpr std::uint32_t kNanosecondsPerSecond = 1'000'000'000;
  if (nanoseconds >= kNanosecondsPerSecond) fail("a time with {} nanoseconds", nanoseconds);
  const std::int64_t signed_seconds =
      is_ros1_ ? std::int64_t{seconds} : std::int64_t{static_cast<std::int32_t>(seconds)};
  return signed_seconds * kNanosecondsPerSecond + nanoseconds;
}

MessageHeader WireReader::header() {
  MessageHeader header;
  if (is_ros1_) header.sequence = number<std::uint32_t>();
  header.stamp_ns = time_ns();
  if (stamp_ns_) header.stamp_ns = *stamp_ns_;
  text();  // the frame's name
  return header;
}

}  // namespace cmap
