#pragma once

#include <vector>

#include "cmap/core/simd.hpp"

namespace cmap::test {

/// The levels of this processor, the plain one first.
inline std::vector<SimdLevel> simd_levels_here() {
  std::vector<SimdLevel> levels{SimdLevel::kPlain, SimdLevel::kSse2, SimdLevel::kAvx2, SimdLevel::kAvx512};
  std::erase_if(levels, [](SimdLevel level) { return level > parse_simd_level(""); });
  return levels;
}

}  // namespace cmap::test
