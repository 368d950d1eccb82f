#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "cmap/geometry/voxel_map.hpp"
#include "measurement.hpp"
#include "space_parts.hpp"

namespace cmap {
namespace {

Box3d box_around(const MapPair& pair) { return united(pair.reference.index.bounds(), pair.estimate.index.bounds()); }

using BlockKey = std::array<std::int64_t, 3>;

/// Numbers the blocks that hold points, in the order in which they are first asked for.
class BlockNumbers {
 public:
  BlockNumbers(const Box3d& box, double block_m) : box_(box), frame_(box, block_m) {}

  /// Of a point.
  std::uint32_t operator()(const Eigen::Vector3d& world) {
    const VoxelKey key = frame_.key(world);
    std::uint32_t& number = numbers_[key];  // 0 where it is new
    if (number == 0) {
      keys_.push_back(frame_.index(key));
      number = static_cast<std::uint32_t>(keys_.size());
    }
    return number - 1;
  }
  /// Of a voxel's center, which may lie where no point is: then the nearest block's, so that no metric adds blocks.
  std::uint32_t nearest(const Eigen::Vector3d& center) const {
    const VoxelKey key = frame_.key(center.cwiseMax(box_.min).cwiseMin(box_.max));
    if (const std::uint32_t* number = numbers_.find(key)) return *number - 1;
    const BlockKey at = frame_.index(key);
    const auto sq_steps = [&](const BlockKey& block) {
      double sum = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) sum += std::pow(static_cast<double>(block[axis] - at[axis]), 2.0);
      return std::pair(sum, block);
    };
    return static_cast<std::uint32_t>(std::ranges::min_element(keys_, {}, sq_steps) - keys_.begin());
  }
  const std::vector<BlockKey>& keys() const { return keys_; }

 private:
  Box3d box_;
  VoxelFrame frame_;
  VoxelMap<std::uint32_t> numbers_;
  std::vector<BlockKey> keys_;
};

/// Blocks by ascending key.
BlockSums sorted(double block_m, const std::vector<BlockKey>& keys, const MetricSums& sums) {
  std::vector<std::size_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::size_t i) { return keys[i]; });
  BlockSums blocks{block_m, {}, {keys.size(), {}}};
  for (std::size_t i : order) blocks.keys.push_back(keys[i]);
  for (const auto& [name, parts] : sums.columns) {
    std::vector<double>& column = blocks.sums.columns[name];
    for (std::size_t i : order) column.push_back(i < parts.size() ? parts[i] : 0.0);
  }
  return blocks;
}

}  // namespace

Intervals intervals_of(const MetricInputs& inputs, std::span<const Metric* const> metrics,
                       const EvaluationOptions& options, std::vector<Warning>& warnings) {
  BlockNumbers numbers(box_around(*inputs.pair), options.block_m);
  const PartOf of_points = std::ref(numbers);
  SpaceParts parts = space_parts(*inputs.pair, of_points, of_points);
  parts.of_voxel = [&](const Eigen::Vector3d& center) { return numbers.nearest(center); };
  const MetricSums sums = sum_metrics(metrics, inputs, std::move(parts));
  Intervals intervals{{}, sorted(options.block_m, numbers.keys(), sums), {}};
  constexpr std::size_t kFew = 20;
  if (intervals.blocks.keys.size() < kFew) {
    warnings.push_back({"intervals_few_blocks",
                        fmt::format("the maps fill only {} blocks of {} m: intervals from so few are too narrow",
                                    intervals.blocks.keys.size(), options.block_m)});
  }
  intervals.options.n_replicates = options.bootstrap;
  intervals.options.seed = options.bootstrap_seed;
  for (const Interval& interval : bootstrap(intervals.blocks, inputs.settings, intervals.options)) {
    if (std::ranges::count(metrics, metric_of(interval.id)) > 0) intervals.metrics.push_back(interval);
  }
  return intervals;
}

}  // namespace cmap
