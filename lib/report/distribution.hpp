#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "cmap/metrics/map_pair.hpp"

namespace cmap {

/// Histogram of one direction: counts of (k w, (k + 1) w], zero in the first, and of what lies beyond the last
/// bin.
struct DirectedDistribution {
  std::vector<std::uint64_t> counts;
  std::uint64_t n_beyond = 0;
  double p95 = 0.0;
};

/// Values by rank, from which a page counts what lies outside of a range: all of them, or where they are many those of
/// evenly spaced ranks, the lowest and the highest among them.
struct RankedValues {
  std::size_t n = 0;  ///< of which these are some
  std::vector<double> values;
};

inline constexpr std::size_t kMostRanked = 10'001;

/// To single precision.
RankedValues ranked(const Array<double>& values);

/// How an error of nearest pairs is distributed; both directions in the same bins, up to the 99th percentile. A pair
/// without both colors has no distance of colors.
struct Distribution {
  double bin_width = 0.0;
  DirectedDistribution estimate_to_reference, reference_to_estimate;
  RankedValues ranked_estimate;  ///< the errors from estimate to reference
};

using PairError = double (NearestPairs::*)(std::size_t slot) const;

Distribution distribution_of(const MapPair& pair, PairError error);

}  // namespace cmap
