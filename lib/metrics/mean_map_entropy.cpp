#include "cmap/metrics/mean_map_entropy.hpp"

#include <cmath>
#include <numbers>

#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

/// ln((2 pi e)^3)
double constant() { return 3.0 * std::log(2.0 * std::numbers::pi * std::numbers::e); }

bool has_enough(const NeighborhoodShape& shape, std::size_t slot, std::uint64_t min_neighbors) {
  return shape.n_neighbors[slot] >= min_neighbors && !std::isnan(shape.covariance_det[slot]);
}

struct EntropySum {
  double log_det = 0.0;
  std::uint64_t n = 0, n_flat = 0;
  EntropySum& operator+=(const EntropySum& other) {
    log_det += other.log_det;
    n += other.n;
    n_flat += other.n_flat;
    return *this;
  }
};

}  // namespace

double point_entropy(const NeighborhoodShape& shape, std::size_t slot, std::uint64_t min_neighbors) {
  if (!has_enough(shape, slot, min_neighbors) || shape.is_flat[slot] != 0) return std::nan("");
  return 0.5 * (constant() + std::log(shape.covariance_det[slot]));
}

MeanMapEntropy mean_map_entropy(const NeighborhoodShape& shape, std::uint64_t min_neighbors) {
  const std::size_t n_points = shape.n_neighbors.size();
  const auto total = ordered_sum<EntropySum>(n_points, kLoopChunk, [&](std::size_t begin, std::size_t end) {
    EntropySum part;
    for (std::size_t i = begin; i < end; ++i) {
      if (!has_enough(shape, i, min_neighbors)) continue;
      part += shape.is_flat[i] != 0 ? EntropySum{0.0, 0, 1} : EntropySum{std::log(shape.covariance_det[i]), 1, 0};
    }
    return part;
  });
  return {0.5 * (constant() + total.log_det / static_cast<double>(total.n)), total.n, n_points - total.n - total.n_flat,
          total.n_flat};
}

}  // namespace cmap
