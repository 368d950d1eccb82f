#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "cmap/eval/bootstrap.hpp"
#include "cmap/spatial/voxel_map.hpp"
#include "eval/fairness_records.hpp"
#include "eval/gathered_sums.hpp"
#include "eval/json_number.hpp"
#include "eval/summed_records.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

Box3d box_around(const MapPair& pair) {
  const Box3d a = pair.reference.index.bounds(), b = pair.estimate.index.bounds();
  return {a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)};
}

/// Numbers the blocks in the order in which they are first asked for.
class BlockNumbers {
 public:
  BlockNumbers(const Box3d& box, double block_m) : frame_(box, block_m) {}

  std::uint32_t operator()(const Eigen::Vector3d& world) {
    const VoxelKey key = frame_.key(world);
    std::uint32_t& number = numbers_[key];  // 0 where it is new
    if (number == 0) {
      keys_.push_back(frame_.index(key));
      number = static_cast<std::uint32_t>(keys_.size());
    }
    return number - 1;
  }
  const std::vector<std::array<std::int64_t, 3>>& keys() const { return keys_; }

 private:
  VoxelFrame frame_;
  VoxelMap<std::uint32_t> numbers_;
  std::vector<std::array<std::int64_t, 3>> keys_;
};

/// Blocks by ascending key.
BlockSums sorted(double block_m, const std::vector<std::array<std::int64_t, 3>>& keys, const MetricSums& sums) {
  std::vector<std::size_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::size_t i) { return keys[i]; });
  BlockSums blocks{block_m, {}, {keys.size(), {}}};
  for (std::size_t i : order) blocks.keys.push_back(keys[i]);
  for (const auto& [name, parts] : sums.columns) {
    std::vector<double>& column = blocks.sums.column(name);
    for (std::size_t i = 0; i < order.size(); ++i) column[i] = order[i] < parts.size() ? parts[order[i]] : 0.0;
  }
  return blocks;
}

}  // namespace

Json interval_records(const Findings& f, const LocalColorRecall* recall, std::vector<Warning>& warnings) {
  if (f.options.bootstrap == 0) return nullptr;
  BlockNumbers numbers(box_around(f.pair), f.options.block_m);
  const PartOf part_of = std::ref(numbers);
  const MetricSums sums = gathered_sums(f, recall, part_of, part_of);
  const BlockSums blocks = sorted(f.options.block_m, numbers.keys(), sums);
  constexpr std::size_t kFew = 20;
  if (blocks.keys.size() < kFew) {
    warnings.push_back({"intervals_few_blocks",
                        fmt::format("the maps fill only {} blocks of {} m: intervals from so few are too narrow",
                                    blocks.keys.size(), f.options.block_m)});
  }
  BootstrapOptions options;
  options.n_replicates = f.options.bootstrap;
  Json metrics = Json::object();
  for (const Interval& v : bootstrap(blocks, options)) {
    if (!f.selection.contains(v.id)) continue;
    add_entry(metrics, v.id, v.threshold_m, {{"lower", json_number(v.lower)}, {"upper", json_number(v.upper)}});
  }
  return {{"method", "spatial block bootstrap, percentiles"},
          {"level", options.level},
          {"replicates", options.n_replicates},
          {"seed", options.seed},
          {"n_blocks", blocks.keys.size()},
          {"metrics", metrics},
          {"blocks", to_json(blocks)}};
}

}  // namespace cmap
