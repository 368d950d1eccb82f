#include "cmap/core/simd.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <optional>

#include "cmap/core/error.hpp"
#include "host_settings.hpp"

namespace cmap {
namespace {

constexpr std::array<std::string_view, 4> kNames{"plain", "sse2", "avx2", "avx512"};

std::optional<SimdLevel> level_of_host;

SimdLevel best_level() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("fma") && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")) {
    return SimdLevel::kAvx512;
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return SimdLevel::kAvx2;
  return SimdLevel::kSse2;
#else
  return SimdLevel::kPlain;
#endif
}

}  // namespace

SimdLevel parse_simd_level(std::string_view requested) {
  const SimdLevel best = best_level();
  if (requested.empty()) return best;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] != requested) continue;
    const auto level = static_cast<SimdLevel>(i);
    if (level > best) throw UsageError(fmt::format("CMAP_SIMD={}: this processor does not have it", requested));
    return level;
  }
  throw UsageError(fmt::format("CMAP_SIMD={}: expected plain, sse2, avx2 or avx512", requested));
}

void take_simd_level(SimdLevel level) { level_of_host = level; }

SimdLevel simd_level() {
  static const SimdLevel level = [] {
    if (level_of_host) return *level_of_host;
    const char* requested = std::getenv("CMAP_SIMD");
    return parse_simd_level(requested == nullptr ? "" : requested);
  }();
  return level;
}

std::string_view simd_level_name(SimdLevel level) { return kNames[static_cast<std::size_t>(level)]; }

}  // namespace cmap
