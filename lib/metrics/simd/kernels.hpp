#pragma once

#include <cstddef>
#include <cstdint>

#include "cmap/core/simd.hpp"
#include "cmap/spatial/point_blocks.hpp"

namespace cmap {

/// A grid of voxels anchored at the world's origin, its voxels cut into parts, and cells of voxels.
struct PartGrid {
  double origin[3];  ///< of the points' offsets
  double voxel_m;
  double first[3];  ///< the index of the voxel of key 0, a whole number
  std::int32_t parts_per_axis, voxels_per_cell;
  std::int32_t edge;         ///< of the places of a cell: its parts, and some more
  std::int32_t first_place;  ///< of its first part
};

/// Of each point of a block the voxel's key, and the part's place in its cell: edges of places, x slowest.
struct GridPlaces {
  alignas(64) std::int32_t x[kBlockSize], y[kBlockSize], z[kBlockSize], in_cell[kBlockSize];
};

/// Of each point of a block the offset from its voxel's corner in whole steps.
struct OffsetLanes {
  alignas(64) std::uint32_t x[kBlockSize], y[kBlockSize], z[kBlockSize];
};

/// Of the iteration for Wasserstein distances (wasserstein.cpp), which begins with up to 1.8 times of what it looks
/// for: whatever that is, what is off is below 1.9 %, 0.12 %, then with Newton's method 3e-8 and 1e-17 of it.
inline constexpr int kFixedPointSteps = 2, kNewtonSteps = 2;

/// The 8-bit colors of both maps in some voxels, side by side. A word is below 2^32 and a voxel of at most 2^16 points.
struct ColorPairLanes {
  static constexpr std::size_t kLanes = 16, kWords = 10;
  /// n; r, g, b; rr, rg, rb, gg, gb, bb: sums over the points.
  alignas(64) std::uint32_t reference[kWords][kLanes], estimate[kWords][kLanes];
};

/// Voxels in rows of the same x, each of which ends with as many that are nowhere (y is infinite) as are looked at at
/// once.
struct RowsOfVoxels {
  static constexpr std::size_t kAtOnce = 8;
  const double *y, *z;  ///< indices
  const double* distance_m;
};

/// Some voxels of one row that follow each other.
struct Stretch {
  std::size_t begin, end;
};

/// The number of voxels, and sums of differences of their distances to that of one among them.
struct NearSums {
  double n, sum, sum_sq;
};

/// One set of kernels for each instruction set, all with bitwise equal results, which no lane's neighbors change.
struct MetricKernels {
  void (*grid_places)(const PartGrid& grid, const PointBlock& points, GridPlaces& places);
  /// Rounded: (world - voxel_m * index) * steps_per_m + 1/2, floored. A point that seems to lie outside of its voxel,
  /// as corners are rounded, too, counts as at the face.
  void (*offsets)(const PartGrid& grid, double steps_per_m, const PointBlock& points, const GridPlaces& places,
                  OffsetLanes& offsets);
  /// The 2-Wasserstein distances of the Gaussians of such voxels, of at least two points each, in levels of 8 bit.
  void (*color_distances)(const ColorPairLanes& pairs, double* distances);
  /// Of the voxels in the stretches, and of those beyond their ends, that are within the radius in y and z.
  NearSums (*near_sums)(const RowsOfVoxels& voxels, const Stretch* stretches, std::size_t n_stretches,
                        std::size_t center, double radius);
};

/// The kernels of one level; `metric_kernels()` are those of simd_level(). The level must be one this processor has.
const MetricKernels& metric_kernels_for(SimdLevel level);
const MetricKernels& metric_kernels();

}  // namespace cmap
