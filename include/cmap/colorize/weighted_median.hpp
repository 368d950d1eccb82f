#pragma once

#include <span>

namespace cmap {

/// A value and what it counts for, above 0.
struct WeightedValue {
  float value = 0.0f, weight = 0.0f;
};

/// The weighted median: sorted by value, each stands in the middle of its own share of the weights; between two of them
/// it is interpolated linearly at one half. For equal weights the median as usual (of an even number the mean of the
/// two); it moves continuously with values and weights. Reorders. NaN of no values. Thread-safe.
float weighted_median(std::span<WeightedValue> values);

}  // namespace cmap
