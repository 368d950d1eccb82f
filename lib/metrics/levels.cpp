#include "cmap/metrics/levels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/core/exact_sum.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/core/random_hash.hpp"
#include "cmap/metrics/metric_sums.hpp"
#include "cmap/spatial/k_nearest.hpp"
#include "cmap/spatial/threshold.hpp"

namespace cmap {
namespace {

constexpr std::uint64_t kSampleSeed = 18;
constexpr const char* kNothing = "no point of the reference has another one that counts";

struct Hashed {
  std::uint64_t hash;
  std::uint32_t slot;
  friend auto operator<=>(const Hashed&, const Hashed&) = default;
};

/// The slots with the n lowest hashes of the original index, the lowest first.
std::vector<std::uint32_t> lowest_hashes(const PointBlocks& points, std::size_t n) {
  // A limit that a quarter more than n hashes are below, of which the lowest n are taken.
  const double share = 1.25 * static_cast<double>(n) / static_cast<double>(points.size);
  const std::uint64_t limit = share < 1.0 ? static_cast<std::uint64_t>(share * 0x1p64) : ~std::uint64_t{0};
  std::vector<std::vector<Hashed>> by_chunk((points.size + kLoopChunk - 1) / kLoopChunk);
  parallel_chunks(points.size, kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const std::uint64_t hash = random_hash(points.original_index[slot], kSampleSeed);
      if (hash <= limit) by_chunk[begin / kLoopChunk].push_back({hash, static_cast<std::uint32_t>(slot)});
    }
  });
  std::vector<Hashed> hashed;
  for (const auto& chunk : by_chunk) hashed.insert(hashed.end(), chunk.begin(), chunk.end());
  std::ranges::sort(hashed);
  std::vector<std::uint32_t> slots;
  for (std::size_t i = 0; i < std::min(n, hashed.size()); ++i) slots.push_back(hashed[i].slot);
  return slots;
}

/// Each of these points' nearest other entry of the same map.
std::vector<SelfPair> self_pairs_of(const IndexedMap& map, std::span<const std::uint32_t> slots) {
  const PointBlocks& points = map.index.points;
  if (points.size < 2) return {};
  const Array<std::uint32_t> queries(slots.begin(), slots.end());
  const Array<std::uint32_t> nearest = find_k_nearest(map.index, chosen_points(points, queries), 2);
  std::vector<SelfPair> pairs;
  pairs.reserve(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    // Of several entries at its place a point may not be among the first two.
    const std::uint32_t other = nearest[2 * i] == slots[i] ? nearest[2 * i + 1] : nearest[2 * i];
    const Eigen::Vector3f a = points.offset(slots[i]), b = points.offset(other);
    const double rounding_m = kThresholdSteps * float_step(a.cwiseAbs().cwiseMax(b.cwiseAbs()).maxCoeff());
    pairs.push_back({slots[i], other, (a.cast<double>() - b.cast<double>()).norm(), rounding_m});
  }
  return pairs;
}

double sum_of(std::span<const double> values) {
  ExactSum sum;
  sum.add(values);
  return sum.value();
}

Record level_record(const Level& level) {
  Record record{.value = level.value};
  if (!std::isfinite(level.value)) {
    record.add("n", level.n);
    return record.add("reason", std::isinf(level.value) ? "it is infinite" : level.reason.c_str());
  }
  return record.add("se", level.se).add("n", level.n);
}

}  // namespace

std::vector<std::uint32_t> LevelInputs::sampled_slots(Side side, std::size_t n) {
  std::optional<std::vector<std::uint32_t>>& by_hash = by_hash_.of(side);
  if (!by_hash) by_hash = lowest_hashes(inputs.map(side).index.points, kMostSampled);
  std::vector<std::uint32_t> slots(by_hash->begin(),
                                   by_hash->begin() + static_cast<std::ptrdiff_t>(std::min(n, by_hash->size())));
  std::ranges::sort(slots);
  return slots;
}

const std::vector<SelfPair>& LevelInputs::self_pairs() {
  if (!self_pairs_) self_pairs_ = self_pairs_of(inputs.pair->reference, sampled_slots(Side::kReference));
  return *self_pairs_;
}

const std::vector<Eigen::Vector3d>& LevelInputs::estimate_colors() {
  if (!estimate_colors_) {
    estimate_colors_.emplace();
    const IndexedMap& map = inputs.estimate;
    for (const std::uint32_t slot : sampled_slots(Side::kEstimate)) {
      if (map.has_color_at(slot)) estimate_colors_->push_back(map.color(slot));
    }
  }
  return *estimate_colors_;
}

Level mean_level(std::span<const double> values) {
  if (values.empty()) return {.reason = kNothing};
  const auto n = static_cast<double>(values.size());
  const double mean = sum_of(values) / n;
  std::vector<double> squares;
  for (const double v : values) squares.push_back((v - mean) * (v - mean));
  const double se = values.size() < 2 ? NAN : std::sqrt(sum_of(squares) / (n - 1.0) / n);
  return {mean, se, values.size()};
}

Level rms_level(std::span<const double> values) {
  std::vector<double> squares;
  for (const double v : values) squares.push_back(v * v);
  Level level = mean_level(squares);
  level.value = std::sqrt(level.value);
  if (level.value > 0.0) level.se /= 2.0 * level.value;  // of a root
  return level;
}

Level share_level(std::uint64_t n_in, std::uint64_t n) {
  if (n == 0) return {.reason = kNothing};
  const double share = static_cast<double>(n_in) / static_cast<double>(n);
  return {share, std::sqrt(share * (1.0 - share) / static_cast<double>(n)), n};
}

Level scaled(Level level, double factor) {
  level.value *= factor;
  level.se *= factor;
  return level;
}

std::vector<SelfPair> self_pairs_within(LevelInputs& levels, const std::optional<double>& threshold_m) {
  if (!threshold_m) return levels.self_pairs();
  std::vector<SelfPair> pairs;
  for (const SelfPair& pair : levels.self_pairs()) {
    if (pair.distance_m <= *threshold_m + pair.rounding_m) pairs.push_back(pair);
  }
  return pairs;
}

std::vector<double> self_distances(LevelInputs& levels, const std::optional<double>& threshold_m) {
  std::vector<double> distances;
  for (const SelfPair& pair : self_pairs_within(levels, threshold_m)) distances.push_back(pair.distance_m);
  return distances;
}

Level self_share(LevelInputs& levels, double threshold_m) {
  const std::vector<SelfPair>& pairs = levels.self_pairs();
  const auto is_in = [&](const SelfPair& pair) { return pair.distance_m <= threshold_m + pair.rounding_m; };
  return share_level(static_cast<std::uint64_t>(std::ranges::count_if(pairs, is_in)), pairs.size());
}

Level halves_level(std::span<const double> distances, double voxel_m, std::uint64_t min_points) {
  constexpr std::size_t kLeastVoxels = 20;
  if (distances.size() >= kLeastVoxels) return mean_level(distances);
  return {.n = distances.size(),
          .reason = fmt::format("fewer than {} voxels of {} m hold {} points of both halves of the reference",
                                kLeastVoxels, voxel_m, min_points)};
}

void add_floor(Record& record, const Level& floor) { record.add("floor", level_record(floor)); }
void add_chance(Record& record, const Level& chance) { record.add("chance", level_record(chance)); }

Level skill_of(double value, const Levels& levels, std::string_view better) {
  const auto& [floor, chance] = levels;
  if (!std::isfinite(value)) return {.reason = std::isnan(value) ? "there is no value" : "the value is infinite"};
  if (std::isnan(floor.value)) return {.reason = "there is no floor: " + floor.reason};
  if (std::isnan(chance.value)) return {.reason = "there is no chance: " + chance.reason};
  if (!std::isfinite(floor.value)) return {.reason = "the floor is infinite"};
  if (!std::isfinite(chance.value)) return {.reason = "the chance is infinite"};
  const auto known = [](double se) { return std::isnan(se) ? 0.0 : se; };
  const double span = chance.value - floor.value, errors = std::hypot(known(floor.se), known(chance.se));
  if ((better == "lower" ? span : -span) <= 2.0 * errors) return {.reason = "the floor is no better than chance"};
  const double by_floor = (chance.value - value) / (span * span), by_chance = (value - floor.value) / (span * span);
  return {(chance.value - value) / span, std::hypot(by_floor * known(floor.se), by_chance * known(chance.se))};
}

void add_levels_of(Record& record, const Levels& levels, std::string_view better) {
  add_floor(record, levels.floor);
  add_chance(record, levels.chance);
  const Level skill = skill_of(record.value.value_or(NAN), levels, better);
  Record part{.value = skill.value};
  record.add("skill", std::isnan(skill.value) ? part.add("reason", skill.reason.c_str()) : part.add("se", skill.se));
}

void add_levels(std::span<const Metric* const> metrics, std::vector<MetricRecord>& records, LevelInputs& levels,
                std::vector<Warning>& warnings) {
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    if (metrics[i]->levels != nullptr) metrics[i]->levels(records[i].record, levels, warnings);
  }
}

}  // namespace cmap
