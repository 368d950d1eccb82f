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

/// How an error of nearest pairs is distributed; both directions in the same bins, up to the 99th percentile.
struct Distribution {
  double bin_width = 0.0;
  DirectedDistribution estimate_to_reference, reference_to_estimate;
};

using PairError = double (NearestPairs::*)(std::size_t slot) const;

Distribution distribution_of(const MapPair& pair, PairError error);

}  // namespace cmap
