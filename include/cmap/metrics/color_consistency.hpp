#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cmap/metrics/map_pair.hpp"

namespace cmap {

/// What a voxel of one point, whose colors cannot scatter, counts as in color consistency.
enum class Singletons {
  kZero,     ///< 0, and every occupied voxel is in the mean, as in the authors' tool
  kExclude,  ///< nothing: voxels of fewer than min_points points are left out
  kRefuse,   ///< there must be none
};

/// Color consistency CCS (paper) of one map: over its occupied voxels floor(world / voxel_m) the mean of tr(cov(c)) in
/// unit RGB squared, n - 1 denominator. Points without color (NaN) occupy no voxel. NaN where no voxel is in the mean.
struct ColorConsistency {
  double zero = 0.0;     ///< over all occupied voxels, those of one point as 0
  double exclude = 0.0;  ///< over those of at least min_points points
  double median = 0.0;   ///< of those of at least 2 points
  std::uint64_t n_occupied = 0;
  std::uint64_t n_enough = 0;      ///< of at least min_points points
  std::uint64_t n_singletons = 0;  ///< of one point
  std::uint64_t n_one_place = 0;   ///< of several points that all lie at one place: copies

  double value(Singletons s) const { return s == Singletons::kExclude ? exclude : zero; }
  std::uint64_t n_voxels(Singletons s) const { return s == Singletons::kExclude ? n_enough : n_occupied; }
};

/// The map needs colors (std::invalid_argument); min_points is at least 2. Throws UsageError for voxels too small to
/// be counted. Deterministic.
ColorConsistency color_consistency(const IndexedMap& map, double voxel_m, std::uint64_t min_points);

/// One voxel: the trace of its colors' covariance.
struct VoxelColorSpread {
  std::array<std::int64_t, 3> index;  ///< floor(world / voxel_m)
  double trace = 0.0;                 ///< unit RGB squared
};

/// The voxels whose mean color_consistency is; throws as it does. Deterministic.
std::vector<VoxelColorSpread> voxel_color_spreads(const IndexedMap& map, double voxel_m, std::uint64_t min_points,
                                                  Singletons singletons);

}  // namespace cmap
