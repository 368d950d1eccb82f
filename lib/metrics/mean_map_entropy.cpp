#include "cmap/metrics/mean_map_entropy.hpp"

#include <cmath>
#include <numbers>

#include "cmap/core/parallel.hpp"
#include "metrics/counted_sum.hpp"

namespace cmap {
namespace {

/// ln((2 pi e)^3)
double constant() { return 3.0 * std::log(2.0 * std::numbers::pi * std::numbers::e); }

bool has_entropy(const NeighborhoodShape& shape, std::size_t slot, std::uint64_t min_neighbors) {
  // NaN, for too few neighbors, is not above 0 either.
  return shape.n_neighbors[slot] >= min_neighbors && shape.covariance_det[slot] > 0.0;
}

}  // namespace

double point_entropy(const NeighborhoodShape& shape, std::size_t slot, std::uint64_t min_neighbors) {
  if (!has_entropy(shape, slot, min_neighbors)) return std::nan("");
  return 0.5 * (constant() + std::log(shape.covariance_det[slot]));
}

MeanMapEntropy mean_map_entropy(const NeighborhoodShape& shape, std::uint64_t min_neighbors) {
  const std::size_t n_points = shape.n_neighbors.size();
  const auto total = ordered_sum<CountedSum>(n_points, kLoopChunk, [&](std::size_t begin, std::size_t end) {
    CountedSum part;
    for (std::size_t i = begin; i < end; ++i) {
      if (has_entropy(shape, i, min_neighbors)) part += {std::log(shape.covariance_det[i]), 1};
    }
    return part;
  });
  return {0.5 * (constant() + total.sum / static_cast<double>(total.n)), total.n, n_points - total.n};
}

}  // namespace cmap
