#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace cmap {

/// The middle value, or the mean of the two; reorders. `values` must not be empty.
template <class T>
T median(std::vector<T>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / T{2};
}

/// Standard deviation of a normal distribution with the same median distance from the center.
inline double robust_sigma(std::vector<double> values, double center) {
  for (double& v : values) v = std::abs(v - center);
  return 1.4826 * median(values);
}

}  // namespace cmap
