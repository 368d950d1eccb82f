#pragma once

#include <span>

#include "cmap/align/pose_pairs.hpp"
#include "cmap/geometry/similarity.hpp"

namespace cmap {

/// How many residuals T source - target in a row say the same: 1 + 2 sum of their correlations over the lags up to the
/// first that is not above 0, or a quarter of the pairs. 1 for white noise; variances grow by it.
double alike_in_a_row(std::span<const PosePair> pairs, const Similarity& T);

}  // namespace cmap
