#pragma once

#include <cstddef>
#include <cstdint>

#include "cmap/core/simd.hpp"

namespace cmap {

/// The 8-bit colors of both maps in some voxels, side by side. A word is below 2^32 and a voxel of at most 2^16 points.
struct ColorPairLanes {
  static constexpr std::size_t kLanes = 16, kWords = 10;
  /// n; r, g, b; rr, rg, rb, gg, gb, bb: sums over the points.
  alignas(64) std::uint32_t reference[kWords][kLanes], estimate[kWords][kLanes];
};

/// One set of kernels for each instruction set, all with bitwise equal results, which no lane's neighbors change.
struct MetricKernels {
  /// The 2-Wasserstein distances of the Gaussians of such voxels, of at least two points each, in levels of 8 bit.
  void (*color_distances)(const ColorPairLanes& pairs, double* distances);
};

/// The kernels of one level; `metric_kernels()` are those of simd_level(). The level must be one this processor has.
const MetricKernels& metric_kernels_for(SimdLevel level);
const MetricKernels& metric_kernels();

}  // namespace cmap
