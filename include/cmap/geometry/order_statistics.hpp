#pragma once

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

}  // namespace cmap
