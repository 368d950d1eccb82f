#include <algorithm>
#include <cmath>

#include "cmap/metrics/color_gaussians.hpp"
#include "color_sums.hpp"

namespace cmap {
namespace {

/// How many points of either map a voxel holds.
struct VoxelCount {
  VoxelIndex index;
  std::uint64_t n_reference, n_estimate;
};

struct CountUse {
  const VoxelFrame* frame;
  std::vector<VoxelCount> voxels;

  void voxel(int, const VoxelKey& key, const PhaseVoxel<WideColorSums>& sums) {
    voxels.push_back({frame->index(key), sums.reference.n(), sums.estimate.n()});
  }
  void halves(const VoxelKey&, const WideColorSums&, const WideColorSums&) {}
};

/// Whether voxels of enough points of both hold half of the points of both.
bool reach_half(const std::vector<VoxelCount>& voxels, std::uint64_t min_points) {
  std::uint64_t n_reference = 0, n_estimate = 0, in_reference = 0, in_estimate = 0;
  for (const VoxelCount& voxel : voxels) {
    n_reference += voxel.n_reference;
    n_estimate += voxel.n_estimate;
    if (voxel.n_reference < min_points || voxel.n_estimate < min_points) continue;
    in_reference += voxel.n_reference;
    in_estimate += voxel.n_estimate;
  }
  return 2 * in_reference >= n_reference && 2 * in_estimate >= n_estimate;
}

/// Voxels of twice the size.
std::vector<VoxelCount> doubled(std::vector<VoxelCount> voxels) {
  for (VoxelCount& voxel : voxels) {
    for (std::int64_t& axis : voxel.index) axis >>= 1;
  }
  std::ranges::sort(voxels, {}, &VoxelCount::index);
  std::vector<VoxelCount> merged;
  for (const VoxelCount& voxel : voxels) {
    if (merged.empty() || merged.back().index != voxel.index) merged.push_back({voxel.index, 0, 0});
    merged.back().n_reference += voxel.n_reference;
    merged.back().n_estimate += voxel.n_estimate;
  }
  return merged;
}

}  // namespace

std::optional<double> voxel_of_half(const MapPair& pair, double voxel_m, std::uint64_t min_points) {
  constexpr int kMostDoublings = 8;
  const PhasedFrame frame(united(pair.reference.index.bounds(), pair.estimate.index.bounds()), voxel_m, 1);
  const WideColorSource source(maps_of(pair), false);
  std::vector<VoxelCount> voxels;
  const PhaseFold<WideColorSource, CountUse> fold(maps_of(pair), frame, source);
  for (const CountUse& use : fold.run({&frame.voxels(), {}})) {
    std::ranges::copy(use.voxels, std::back_inserter(voxels));
  }
  for (int doublings = 0; doublings < kMostDoublings; ++doublings) {
    if (reach_half(voxels, min_points)) return std::ldexp(voxel_m, doublings);
    voxels = doubled(std::move(voxels));
  }
  return std::nullopt;
}

}  // namespace cmap
