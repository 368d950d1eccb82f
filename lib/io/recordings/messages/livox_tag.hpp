#pragma once

#include <cstdint>

namespace cmap {

/// What Livox says of a point in bits 4 and 5 of its tag: 0 and 1 are returns, 2 and 3 noise by energy.
inline bool is_livox_point(std::uint8_t tag) { return (tag & 0x30U) <= 0x10U; }

}  // namespace cmap
