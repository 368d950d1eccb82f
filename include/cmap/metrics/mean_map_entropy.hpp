#pragma once

#include <cstdint>

#include "cmap/spatial/radius.hpp"

namespace cmap {

/// Mean map entropy MME (nats) of one map: the mean over points of 1/2 ln((2 pi e)^3 det C), C the covariance of the
/// neighbors within the radius, the point itself left out. Points with fewer than min_neighbors neighbors are left out
/// and counted, and so are those whose neighbors are flat to the rounding of their coordinates: the entropy would be
/// the rounding's. NaN if that leaves none.
struct MeanMapEntropy {
  double value = 0.0;
  std::uint64_t n = 0;
  std::uint64_t n_left_out = 0;  ///< too few neighbors
  std::uint64_t n_flat = 0;      ///< enough, but flat
};
MeanMapEntropy mean_map_entropy(const NeighborhoodShape& shape, std::uint64_t min_neighbors);

/// The entropy of one point's neighborhood; NaN where it is left out.
double point_entropy(const NeighborhoodShape& shape, std::size_t slot, std::uint64_t min_neighbors);

}  // namespace cmap
