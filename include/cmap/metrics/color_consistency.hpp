#pragma once

#include <cstdint>

#include "cmap/metrics/map_pair.hpp"

namespace cmap {

/// Color consistency CCS (paper) of one map: over voxels floor(world / voxel_m) with at least min_points points, the
/// mean of tr(cov(c)) in unit RGB squared, n - 1 denominator. NaN where no voxel qualifies.
struct ColorConsistency {
  double mean = 0.0;
  double median = 0.0;
  std::uint64_t n_voxels = 0;
  std::uint64_t n_voxels_below_min = 0;
};

/// The map needs colors (std::invalid_argument); min_points is at least 2. Throws UsageError for voxels too small to
/// be counted. Deterministic.
ColorConsistency color_consistency(const IndexedMap& map, double voxel_m, std::uint64_t min_points);

}  // namespace cmap
