#pragma once

#include <span>

namespace cmap {

/// Means over one side's distances to the other map, from the sums of metric `chamfer`.
struct MeanDistances {
  double n, mean_m, mean_sq_m2, mean_truncated_m;  ///< truncated: each distance at most the overlap distance
};
MeanDistances mean_distances(std::span<const double> chamfer_sums);

/// Harmonic mean 2PR / (P + R) of precision and recall; 0 when both are 0, NaN when either is.
double f_score(double precision, double recall);

}  // namespace cmap
