#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cmap/core/exact_sum.hpp"
#include "cmap/metrics/map_pair.hpp"
#include "cmap/metrics/metric_options.hpp"

namespace cmap {

/// One voxel's colors.
struct VoxelColors {
  std::array<std::int64_t, 3> index;  ///< floor(world / voxel_m)
  std::uint64_t n = 0;                ///< points that have a color
  bool one_place = false;             ///< all at one place
  double trace = 0.0;                 ///< of the colors' covariance (n - 1), unit RGB squared; 0 of one point
};

/// Whether the voxel is in the mean.
inline bool is_in_mean(const VoxelColors& voxel, Singletons singletons, std::uint64_t min_points) {
  return singletons != Singletons::kExclude || voxel.n >= min_points;
}

/// Sums over the occupied voxels of a map, and the median of the traces of those of at least 2 points.
struct ColorConsistency {
  ExactSum n_occupied, n_enough, n_singletons, n_one_place;  ///< of at least min_points; of one; of copies of one
  ExactSum trace, trace_of_enough, sq_trace_of_enough;
  double median = 0.0;
};

/// In one pass, without holding all voxels. The map needs colors (std::invalid_argument). Throws UsageError for voxels
/// too small to be counted. The same for any number of threads.
ColorConsistency color_consistency(const IndexedMap& map, double voxel_m, std::uint64_t min_points);

/// The value under the options' rule for each phase of the grid ("Levels" of METRICS), x slowest; NaN where no voxel
/// counts. The map needs colors. The same for any number of threads and any order of the points.
std::vector<double> color_consistency_phases(const IndexedMap& map, const MetricOptions& options);

/// The occupied voxels, in an order that is always the same; throws as color_consistency does.
std::vector<VoxelColors> voxel_colors(const IndexedMap& map, double voxel_m);

}  // namespace cmap
