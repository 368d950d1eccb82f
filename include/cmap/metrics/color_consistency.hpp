#pragma once

#include <array>
#include <cstdint>
#include <vector>

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

/// One voxel with at least min_points points: the trace of its colors' covariance.
struct VoxelColorSpread {
  std::array<std::int64_t, 3> index;  ///< floor(world / voxel_m)
  double trace = 0.0;                 ///< unit RGB squared
};

/// What color_consistency averages, voxel by voxel; throws as it does. Deterministic.
std::vector<VoxelColorSpread> voxel_color_spreads(const IndexedMap& map, double voxel_m, std::uint64_t min_points);

}  // namespace cmap
