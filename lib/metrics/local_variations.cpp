#include <algorithm>
#include <cmath>

#include "cmap/core/exact_sum.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/metrics/wasserstein.hpp"

namespace cmap {
namespace {

/// Coefficient of variation of the distances around a voxel; NaN where the voxel is to be skipped.
/// Differences to the voxel's own distance are summed: equal distances give a variance of exactly 0.
double local_variation(std::span<const VoxelDistance> voxels, std::size_t center, int radius) {
  const VoxelIndex& at = voxels[center].index;
  double n = 0.0, sum = 0.0, sum_sq = 0.0;
  for (std::int64_t x = at[0] - radius; x <= at[0] + radius; ++x) {
    for (std::int64_t y = at[1] - radius; y <= at[1] + radius; ++y) {
      const VoxelIndex first{x, y, at[2] - radius};
      const VoxelIndex last{x, y, at[2] + radius};
      auto other = std::ranges::lower_bound(voxels, first, {}, &VoxelDistance::index);
      for (; other != voxels.end() && other->index <= last; ++other) {
        if (other->index == at) continue;
        const double difference = other->distance_m - voxels[center].distance_m;
        n += 1.0;
        sum += difference;
        sum_sq += difference * difference;
      }
    }
  }
  const double mean = voxels[center].distance_m + sum / n;
  const double variance = std::max(0.0, sum_sq / n - (sum / n) * (sum / n));
  return n > 0.0 && mean > 0.0 ? std::sqrt(variance) / mean : std::nan("");
}

}  // namespace

std::vector<double> local_variations(std::span<const VoxelDistance> voxels, int radius_voxels) {
  constexpr std::size_t kVoxelChunk = 64;
  std::vector<double> variations(voxels.size());
  parallel_chunks(voxels.size(), kVoxelChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) variations[i] = local_variation(voxels, i, radius_voxels);
  });
  return variations;
}

double mean_variation(std::span<const double> variations) {
  ExactSum sum;
  std::uint64_t n = 0;
  for (const double variation : variations) {
    if (std::isnan(variation)) continue;
    sum.add(variation);
    ++n;
  }
  return sum.value() / static_cast<double>(n);
}

}  // namespace cmap
