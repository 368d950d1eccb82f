#pragma once

#include <cstddef>
#include <span>

#include "cmap/core/array.hpp"

namespace cmap {

/// Unpacks zstd frames; the number of bytes. Throws InputError with the reason alone, also where they do not fit;
/// UnsupportedError where this build is without zstd.
std::size_t unpack_zstd(std::span<const std::byte> packed, std::span<std::byte> out);

/// A message as it was sent: rosbag2 can pack each by itself, which no container says, but a message of CDR never
/// begins as a frame of zstd does. Unpacked into `room`, or where it is.
std::span<const std::byte> sent_message(std::span<const std::byte> stored, Array<std::byte>& room);

}  // namespace cmap
