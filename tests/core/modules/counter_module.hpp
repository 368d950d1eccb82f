#pragma once

#include "cmap/core/simd.hpp"

namespace cmap::testing {

/// What the modules of the tests give, and how often the loop is run in them.
struct CounterTable {
  static constexpr const char* kModule = "counter";
  static constexpr int kTable = 7;
  int (*threads)();
  SimdLevel (*simd)();
  /// Runs a parallel loop; the number of its chunks.
  int (*count)(int n);
};

}  // namespace cmap::testing
