#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace cmap {

/// The checksum of ZIP, PNG and MCAP (polynomial 0xEDB88320), continued from that of what stands before; of nothing it
/// is 0.
inline std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace cmap
