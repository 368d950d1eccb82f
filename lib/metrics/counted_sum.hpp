#pragma once

#include <cstdint>

namespace cmap {

/// A sum and the number of its terms, for ordered_sum.
struct CountedSum {
  double sum = 0.0;
  std::uint64_t n = 0;
  CountedSum& operator+=(const CountedSum& other) {
    sum += other.sum;
    n += other.n;
    return *this;
  }
};

}  // namespace cmap
