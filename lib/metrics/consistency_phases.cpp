#include "cmap/core/exact_sum.hpp"
#include "cmap/metrics/color_consistency.hpp"
#include "color_sums.hpp"

namespace cmap {
namespace {

/// What the mean of each phase is made of.
struct ConsistencyUse {
  Singletons singletons;
  std::uint64_t min_points;
  std::vector<ExactSum> traces;  ///< by phase
  std::vector<std::uint64_t> counts;

  double step;

  void voxel(int phase, const VoxelKey&, const PhaseVoxel<WideColorSums>& sums) {
    const std::uint64_t n = sums.estimate.n();
    if (n == 0 || !is_in_mean({.index = {}, .n = n}, singletons, min_points)) return;
    ++counts[static_cast<std::size_t>(phase)];
    if (n < 2) return;
    traces[static_cast<std::size_t>(phase)].add(sums.estimate.gaussian(step).covariance().trace());
  }
  void halves(const VoxelKey&, const WideColorSums&, const WideColorSums&) {}
};

}  // namespace

std::vector<double> color_consistency_phases(const IndexedMap& map, const MetricOptions& options) {
  const PhasedFrame frame(map.index.bounds(), options.ccs_voxel_m, static_cast<int>(options.grid_phases));
  const auto n_phases = static_cast<std::size_t>(frame.n_phases());
  const BothSides<const IndexedMap*> alone{&map, nullptr};
  const WideColorSource source(alone, false);
  const ConsistencyUse none{options.ccs_singletons, options.ccs_min_points, std::vector<ExactSum>(n_phases),
                            std::vector<std::uint64_t>(n_phases), source.step};
  ConsistencyUse all = none;
  for (const ConsistencyUse& use : PhaseFold<WideColorSource, ConsistencyUse>(alone, frame, source).run(none)) {
    for (std::size_t phase = 0; phase < n_phases; ++phase) {
      all.traces[phase] += use.traces[phase];
      all.counts[phase] += use.counts[phase];
    }
  }
  std::vector<double> means;
  for (std::size_t phase = 0; phase < n_phases; ++phase) {
    means.push_back(all.traces[phase].value() / static_cast<double>(all.counts[phase]));
  }
  return means;
}

}  // namespace cmap
