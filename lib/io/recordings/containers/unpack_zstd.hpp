#pragma once

#include <cstddef>
#include <span>

namespace cmap {

/// Unpacks zstd frames; the number of bytes. Throws InputError with the reason alone, also where they do not fit;
/// UnsupportedError where this build is without zstd.
std::size_t unpack_zstd(std::span<const std::byte> packed, std::span<std::byte> out);

}  // namespace cmap
