#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace cmap {

/// The checksum of ZIP, PNG and MCAP (polynomial 0xEDB88320), continued from that of what stands before; of nothing it
/// is 0. With carry-less multiplication where the processor has it, which is ten times as fast.
std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace cmap
