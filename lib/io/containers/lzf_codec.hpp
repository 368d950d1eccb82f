#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cmap/core/array.hpp"

namespace cmap {

/// The most bytes that `compressed` LZF bytes can stand for: a reference of 3 bytes yields 264.
inline std::uint64_t lzf_max_size(std::uint64_t compressed) { return 88 * compressed; }

/// False unless the bytes are LZF for exactly out.size() bytes.
bool lzf_expand(std::span<const std::byte> compressed, std::span<std::byte> out);

/// Empty if the result would not fit into LZF's 32-bit sizes.
Array<std::byte> lzf_shrink(std::span<const std::byte> bytes);

}  // namespace cmap
