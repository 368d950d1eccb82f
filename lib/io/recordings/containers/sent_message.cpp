#include <fmt/format.h>

#include "bytes/little_endian.hpp"
#include "cmap/core/error.hpp"
#include "recordings/containers/unpack_zstd.hpp"

namespace cmap {
namespace {

constexpr std::uint32_t kZstdFrame = 0xFD2FB528;

/// What a frame's header says (RFC 8878, 3.1.1.1); 0: it does not say, or is cut off.
std::uint64_t unpacked_bytes(std::span<const std::byte> frame) {
  if (frame.size() < 5) return 0;
  const auto descriptor = std::to_integer<unsigned>(frame[4]);
  const bool is_single_segment = (descriptor & 0x20U) != 0;
  constexpr std::size_t kDictionaryBytes[] = {0, 1, 2, 4};
  const std::size_t place = 5 + (is_single_segment ? 0 : 1) + kDictionaryBytes[descriptor & 3U];
  const unsigned size_flag = descriptor >> 6U;
  if (frame.size() < place + (std::size_t{1} << size_flag) || (size_flag == 0 && !is_single_segment)) return 0;
  if (size_flag == 0) return std::to_integer<std::uint64_t>(frame[place]);
  if (size_flag == 1) return 256U + load_little<std::uint16_t>(frame, place);
  return size_flag == 2 ? load_little<std::uint32_t>(frame, place) : load_little<std::uint64_t>(frame, place);
}

}  // namespace

std::span<const std::byte> sent_message(std::span<const std::byte> stored, Array<std::byte>& room) {
  if (stored.size() < 4 || load_little<std::uint32_t>(stored, 0) != kZstdFrame) return stored;
  constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
  const std::uint64_t bytes = unpacked_bytes(stored);
  if (bytes == 0 || bytes > kMost) throw InputError(fmt::format("a message packed by zstd of {} bytes", bytes));
  room.clear();
  room.resize(bytes);
  return std::span(room).first(unpack_zstd(stored, room));
}

}  // namespace cmap
