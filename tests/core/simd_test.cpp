#include "cmap/core/simd.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "cmap/core/error.hpp"

namespace cmap {
namespace simd_test {

constexpr SimdLevel kLevels[] = {SimdLevel::kPlain, SimdLevel::kSse2, SimdLevel::kAvx2, SimdLevel::kAvx512};

/// Whether the kernel lists the processor feature.
bool kernel_lists(const std::string& feature) {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.starts_with("flags")) return (line + ' ').find(' ' + feature + ' ') != std::string::npos;
  }
  return false;
}

std::string refusal(std::string_view requested) {
  try {
    parse_simd_level(requested);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(SimdLevel, Names) {
  EXPECT_EQ(simd_level_name(SimdLevel::kPlain), "plain");
  EXPECT_EQ(simd_level_name(SimdLevel::kSse2), "sse2");
  EXPECT_EQ(simd_level_name(SimdLevel::kAvx2), "avx2");
  EXPECT_EQ(simd_level_name(SimdLevel::kAvx512), "avx512");
}

TEST(ParseSimdLevel, TakesEveryLevelThatTheProcessorHas) {
  for (SimdLevel level : kLevels) {
    const std::string_view name = simd_level_name(level);
    const bool available =
        level == SimdLevel::kPlain || kernel_lists(level == SimdLevel::kAvx512 ? "avx512vl" : std::string(name));
    if (available) {
      EXPECT_EQ(parse_simd_level(name), level);
    } else {
      EXPECT_NE(refusal(name).find("this processor does not have it"), std::string::npos) << name;
    }
  }
}

TEST(ParseSimdLevel, EmptyIsTheBest) {
  SimdLevel best = SimdLevel::kPlain;
  for (SimdLevel level : kLevels) {
    if (refusal(simd_level_name(level)).empty()) best = level;
  }
  EXPECT_EQ(parse_simd_level(""), best);
}

TEST(ParseSimdLevel, RefusesUnknownNamesAndSaysWhichThereAre) {
  for (std::string_view name : {"avx", "AVX2", "sse2 ", "avx2,avx512", "none", "2"}) {
    EXPECT_EQ(refusal(name), "CMAP_SIMD=" + std::string(name) + ": expected plain, sse2, avx2 or avx512");
  }
}

TEST(SimdLevel, IsReadFromTheEnvironmentOnce) {
  setenv("CMAP_SIMD", "plain", 1);
  EXPECT_EQ(simd_level(), SimdLevel::kPlain);
  setenv("CMAP_SIMD", "no such level", 1);
  EXPECT_EQ(simd_level(), SimdLevel::kPlain);
  unsetenv("CMAP_SIMD");
}

}  // namespace simd_test
}  // namespace cmap
