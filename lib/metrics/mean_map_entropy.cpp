#include "cmap/metrics/mean_map_entropy.hpp"

#include <cmath>
#include <numbers>

#include "cmap/core/parallel.hpp"
#include "metrics/counted_sum.hpp"

namespace cmap {

MeanMapEntropy mean_map_entropy(const NeighborhoodShape& shape, std::uint64_t min_neighbors) {
  const std::size_t n_points = shape.n_neighbors.size();
  const auto total = ordered_sum<CountedSum>(n_points, kLoopChunk, [&](std::size_t begin, std::size_t end) {
    CountedSum part;
    for (std::size_t i = begin; i < end; ++i) {
      // NaN, for too few neighbors, is not above 0 either.
      if (shape.n_neighbors[i] < min_neighbors || !(shape.covariance_det[i] > 0.0)) continue;
      part += {std::log(shape.covariance_det[i]), 1};
    }
    return part;
  });
  const double constant = 3.0 * std::log(2.0 * std::numbers::pi * std::numbers::e);
  return {0.5 * (constant + total.sum / static_cast<double>(total.n)), total.n, n_points - total.n};
}

}  // namespace cmap
