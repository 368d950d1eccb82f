#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cmap/metrics/wasserstein.hpp"

namespace cmap {

/// A voxel that holds enough points of both maps that have a color.
struct ColoredVoxel {
  VoxelIndex index;
  double distance;  ///< 2-Wasserstein, of the Gaussians of both maps' colors, unit RGB
  std::uint64_t n_reference, n_estimate;
};

/// One of them with the reference's colors: a Gaussian of unit RGB in place of meters.
struct ReferenceColors {
  VoxelIndex index;
  std::uint64_t seed;  ///< from where it lies among the others
  std::uint64_t n_estimate;
  Gaussian reference;
};

/// What color Wasserstein is the mean of ("color_wasserstein" and "Levels" of METRICS).
struct ColorWasserstein {
  std::vector<ColoredVoxel> voxels;  ///< of the grid at the world's origin, in an order that is always the same
  std::vector<double> phase_means;   ///< x slowest; the first is of `voxels`; NaN where no voxel qualifies
  std::vector<double> of_halves;     ///< distances between two random halves of the reference, if asked for; any order
  std::vector<ReferenceColors> sample;  ///< of at most 20,000 of the voxels, ordered by seed; if halves are asked for
};

/// In one pass over the points. Both maps need colors (std::invalid_argument). Throws UsageError for voxels too small
/// to be counted. The same bits for any number of threads and any order of the points (but for the halves, which the
/// original index decides).
ColorWasserstein color_wasserstein(const MapPair& pair, const PhaseOptions& options);

/// The smallest doubling of the voxel at which those of at least min_points of both maps hold half of the points of
/// both; none up to 128 times.
std::optional<double> voxel_of_half(const MapPair& pair, double voxel_m, std::uint64_t min_points);

}  // namespace cmap
