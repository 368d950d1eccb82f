#include "cmap/metrics/color_gaussians.hpp"

#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "cmap/core/exact_sum.hpp"
#include "color_sums.hpp"

namespace cmap {
namespace {

/// Takes the voxels of one task.
struct ColorUse {
  std::uint64_t min_points;
  double step;
  bool with_sample;
  std::vector<ColoredVoxel> voxels;
  std::vector<ReferenceColors> sample;
  std::vector<double> of_halves;
  std::vector<ExactSum> sums;  ///< by phase
  std::vector<std::uint64_t> counts;

  void voxel(int phase, const VoxelIndex& index, const PhaseVoxel<ColorSums>& colors) {
    if (colors.reference.n() < min_points || colors.estimate.n() < min_points) return;
    const Gaussian reference = colors.reference.gaussian(step);
    const double distance = wasserstein_distance(reference, colors.estimate.gaussian(step));
    sums[static_cast<std::size_t>(phase)].add(distance);
    ++counts[static_cast<std::size_t>(phase)];
    if (phase > 0) return;
    voxels.push_back({index, distance, colors.reference.n(), colors.estimate.n()});
    if (with_sample) sample.push_back({index, 0, colors.estimate.n(), reference});
  }
  void halves(const ColorSums& one, const ColorSums& other) {
    if (one.n() < min_points || other.n() < min_points) return;
    of_halves.push_back(wasserstein_distance(one.gaussian(step), other.gaussian(step)));
  }

  void take(ColorUse other) {
    std::ranges::copy(other.voxels, std::back_inserter(voxels));
    std::ranges::copy(other.of_halves, std::back_inserter(of_halves));
    for (std::size_t phase = 0; phase < sums.size(); ++phase) {
      sums[phase] += other.sums[phase];
      counts[phase] += other.counts[phase];
    }
  }
};

/// The first corner of the voxels that the tasks have taken.
VoxelIndex first_index(std::span<const ColorUse> used) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  VoxelIndex first{kMost, kMost, kMost};
  for (const ColorUse& use : used) {
    for (const ColoredVoxel& voxel : use.voxels) {
      for (std::size_t axis = 0; axis < 3; ++axis) first[axis] = std::min(first[axis], voxel.index[axis]);
    }
  }
  return first;
}

/// At most 20,000 of the tasks' samples: those with the lowest hashes of where they lie among the others, which become
/// their seeds; ordered by these. The rest is dropped.
std::vector<ReferenceColors> take_sample(std::span<ColorUse> used) {
  constexpr std::size_t kMost = 20'000;
  constexpr std::uint64_t kSeed = 19;
  const VoxelIndex first = first_index(used);
  std::vector<ReferenceColors*> all;
  for (ColorUse& use : used) {
    for (ReferenceColors& voxel : use.sample) {
      voxel.seed = kSeed;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        voxel.seed = random_hash(static_cast<std::uint64_t>(voxel.index[axis] - first[axis]), voxel.seed);
      }
      all.push_back(&voxel);
    }
  }
  const auto seed = [](const ReferenceColors* voxel) { return voxel->seed; };
  if (all.size() > kMost) {
    std::ranges::nth_element(all, all.begin() + kMost, {}, seed);
    all.resize(kMost);
  }
  std::ranges::sort(all, {}, seed);
  std::vector<ReferenceColors> sample;
  for (const ReferenceColors* voxel : all) sample.push_back(*voxel);
  for (ColorUse& use : used) use.sample = {};
  return sample;
}

}  // namespace

ColorWasserstein color_wasserstein(const MapPair& pair, const PhaseOptions& options) {
  if (!pair.has_color()) throw std::invalid_argument("color_wasserstein: both maps need colors");
  const PhasedFrame frame(united(pair.reference.index.bounds(), pair.estimate.index.bounds()), options.voxel_m,
                          options.parts_per_axis);
  const auto n_phases = static_cast<std::size_t>(frame.n_phases());
  const ColorSource source(maps_of(pair), options.halves);
  const ColorUse none{std::max<std::uint64_t>(options.min_points, 2),
                      source.step,
                      options.halves,
                      {},
                      {},
                      {},
                      std::vector<ExactSum>(n_phases),
                      std::vector<std::uint64_t>(n_phases)};
  std::vector<ColorUse> used = PhaseFold<ColorSource, ColorUse>(maps_of(pair), frame, source).run(none);
  ColorWasserstein found;
  found.sample = take_sample(used);
  ColorUse all = none;
  for (ColorUse& use : used) all.take(std::move(use));
  found.voxels = std::move(all.voxels);
  found.of_halves = std::move(all.of_halves);
  for (std::size_t phase = 0; phase < n_phases; ++phase) {
    found.phase_means.push_back(all.sums[phase].value() / static_cast<double>(all.counts[phase]));
  }
  return found;
}

}  // namespace cmap
