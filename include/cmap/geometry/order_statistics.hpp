#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace cmap {

/// Quantiles with linear interpolation (type 7): rank h = (n - 1) p between the order statistics around it.
/// `values` must be finite and not negative. No values: NaN for every quantile. One pass over the values plus one over
/// those near the ranks; nothing is sorted.
std::vector<double> quantiles(std::span<const double> values, std::span<const double> shares);

/// A quantile of the `n_first` lowest values, as for "the median of those <= t".
struct PrefixQuantile {
  std::uint64_t n_first;
  double share;
};

inline double identity(double v) { return v; }

/// Quantiles of measure(value), a rising function of the values that need not be computed for all of them.
std::vector<double> prefix_quantiles(std::span<const double> values, std::span<const PrefixQuantile> wanted,
                                     double (*measure)(double) = &identity);

/// The value at a rank (0: the lowest), which must be below the number of values; reorders them.
template <class Values>
typename Values::value_type value_at_rank(Values& values, std::size_t rank) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The middle value, of an even number the upper one; reorders. `values` must not be empty.
template <class Values>
typename Values::value_type upper_median(Values& values) {
  return value_at_rank(values, values.size() / 2);
}

/// The middle value, or the mean of the two; reorders. `values` must not be empty.
template <class Values>
typename Values::value_type median(Values& values) {
  const auto upper = upper_median(values);
  if (values.size() % 2 == 1) return upper;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  return (upper + *std::max_element(values.begin(), middle)) / typename Values::value_type{2};
}

/// Standard deviation of a normal distribution with the same median distance from the center.
inline double robust_sigma(std::vector<double> values, double center) {
  for (double& v : values) v = std::abs(v - center);
  return 1.4826 * median(values);
}

}  // namespace cmap
