#pragma once

#include <vector>

#include "cmap/metrics/metric.hpp"

namespace cmap {

/// Where the sums of color distances and of their pairs stand among the columns.
inline constexpr std::size_t kColorColumn = 0, kColoredPairsColumn = 1;

/// Mean color distance of one side's pairs, unit RGB; NaN over none.
inline double mean_color_distance(std::span<const double> sums) {
  return sums[kColorColumn] / sums[kColoredPairsColumn];
}

/// Color distance CD (paper): the mean of both sides' means.
inline double mean_color_distance(const PairSums& sums) {
  return 0.5 * (mean_color_distance(sums.estimate) + mean_color_distance(sums.reference));
}

/// Adds the color distances of the pairs that count: within color_max_distance_m, and not NaN.
void add_color_distances(const PointRun& run, std::span<const double> color_distance, std::span<ExactSum> sums);

/// Adds both sides' means.
void add_color_directions(Record& record, const PairSums& sums);

/// Adds over how many pairs they are.
void add_color_counts(Record& record, const PairSums& sums);

}  // namespace cmap
