#pragma once

// What another tool prints, to lay beside our own numbers (METRICS, "What other tools print"). Every function is
// pure; distances are squared nearest distances in m^2, NaN stands for "no value".

#include <cstdint>
#include <span>
#include <vector>

#include "cmap/metrics/wasserstein.hpp"
#include "cmap/spatial/radius.hpp"

namespace cmap {

/// MapEval 1.0 with its initial matrix only: correspondences are d^2 <= overlap_distance_m (the tool compares a square
/// with meters); AC = sqrt(sum_{d <= t} d^2 / correspondences), COM = #(d <= t) / #estimate.
struct MapEvalAccuracy {
  std::vector<double> accuracy_m;  ///< per threshold
  std::vector<double> completeness;
  std::uint64_t n_correspondences = 0;
};
MapEvalAccuracy mapeval_accuracy(std::span<const double> sq_dist, std::span<const double> thresholds_m,
                                 double overlap_distance_m);

/// MapEval's voxel distances: covariance scatter / (n - 1)^3 (n > 10; else divided once), eigenvalues raised to 1e-6,
/// and a Cholesky factor in place of the matrix root. Their mean is its AWD, spatial_consistency() its SCS.
std::vector<VoxelDistance> mapeval_wasserstein_distances(std::span<const GaussianPair> pairs);

/// MapEval's mean map entropy: 1/2 ln(2 pi e det C) over the points of at least min_neighbors neighbors whose det C is
/// above 0.
struct MapEvalEntropy {
  double value;
  std::uint64_t n_valid;
};
MapEvalEntropy mapeval_entropy(const NeighborhoodShape& shape, std::uint64_t min_neighbors);

}  // namespace cmap
