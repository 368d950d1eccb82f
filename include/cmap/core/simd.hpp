#pragma once

#include <string_view>

namespace cmap {

/// Instruction sets that kernels exist for. Results are bitwise the same at every level.
enum class SimdLevel { kPlain, kSse2, kAvx2, kAvx512 };

/// The level that kernels run at: the best one of this processor, or what the environment variable CMAP_SIMD
/// (plain, sse2, avx2, avx512) asks for. Throws UsageError where it asks for an unknown level or one that this
/// processor lacks. Thread-safe; read once per process.
SimdLevel simd_level();

/// The level of one name and processor; `requested` empty means the best. What simd_level() does, testable.
SimdLevel parse_simd_level(std::string_view requested);

std::string_view simd_level_name(SimdLevel level);

}  // namespace cmap
