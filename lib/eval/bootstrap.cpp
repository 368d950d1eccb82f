#include "cmap/eval/bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

/// How often each of n blocks is drawn when n are; the same for every standard library.
std::vector<double> draw(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> weights(n);
  for (std::size_t i = 0; i < n; ++i) {
    __extension__ using Wide = unsigned __int128;
    ++weights[static_cast<std::size_t>(static_cast<Wide>(random()) * n >> 64)];
  }
  return weights;
}

/// Sorts; type 7 as everywhere.
double quantile(std::vector<double>& values, double share) {
  std::ranges::sort(values);
  const double rank = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (rank - static_cast<double>(below)) * (values[above] - values[below]);
}

using ValuesOf = std::function<std::vector<SummedValue>(std::span<const double> weights)>;

std::vector<Interval> resampled(std::size_t n_blocks, const BootstrapOptions& options, const ValuesOf& values_for) {
  const std::vector<double> once(n_blocks, 1.0);
  std::vector<Interval> intervals;
  for (const SummedValue& v : values_for(once)) intervals.push_back({v.id, v.threshold_m, v.value, NAN, NAN});
  // Apart from those of any other seed; the replicates of seed 1 begin with 1.
  const std::uint64_t first_seed = 1 + (options.seed - 1) * kMostReplicates;
  std::vector<std::vector<SummedValue>> replicates(options.n_replicates);
  parallel_chunks(options.n_replicates, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) replicates[i] = values_for(draw(n_blocks, first_seed + i));
  });
  constexpr double kNeeded = 0.9;  // of the replicates
  for (std::size_t m = 0; m < intervals.size(); ++m) {
    std::vector<double> values;
    for (const auto& replicate : replicates) {
      if (std::isfinite(replicate[m].value)) values.push_back(replicate[m].value);
    }
    if (values.empty() || static_cast<double>(values.size()) < kNeeded * static_cast<double>(options.n_replicates)) {
      continue;
    }
    intervals[m].lower = quantile(values, 0.5 * (1.0 - options.level));
    intervals[m].upper = quantile(values, 0.5 * (1.0 + options.level));
  }
  return intervals;
}

/// The sums with the rows of `keys`, zero where a block is not among them.
MetricSums aligned(const BlockSums& blocks, const std::vector<std::array<std::int64_t, 3>>& keys) {
  MetricSums result{keys.size(), {}};
  for (const auto& [name, parts] : blocks.sums.columns) {
    std::vector<double>& column = result.columns.emplace(name, std::vector<double>(keys.size())).first->second;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      column[static_cast<std::size_t>(std::ranges::lower_bound(keys, blocks.keys[i]) - keys.begin())] = parts[i];
    }
  }
  return result;
}

}  // namespace

std::vector<Interval> bootstrap(const BlockSums& blocks, const MetricSettings& settings,
                                const BootstrapOptions& options) {
  const MetricFormulas formulas(blocks.sums, settings);
  return resampled(blocks.keys.size(), options,
                   [&](std::span<const double> weights) { return formulas.values(weights); });
}

std::vector<Interval> bootstrap_difference(const BlockSums& a, const MetricSettings& settings_a, const BlockSums& b,
                                           const MetricSettings& settings_b, const BootstrapOptions& options) {
  if (a.block_m != b.block_m) throw std::invalid_argument("bootstrap_difference: blocks of two sizes");
  std::vector<std::array<std::int64_t, 3>> keys;
  std::ranges::set_union(a.keys, b.keys, std::back_inserter(keys));
  const MetricSums sums_a = aligned(a, keys), sums_b = aligned(b, keys);
  const MetricFormulas formulas_a(sums_a, settings_a), formulas_b(sums_b, settings_b);
  return resampled(keys.size(), options, [&](std::span<const double> weights) {
    const std::vector<SummedValue> of_a = formulas_a.values(weights);
    std::vector<SummedValue> differences;
    for (SummedValue v : formulas_b.values(weights)) {
      const auto same = std::ranges::find_if(
          of_a, [&](const SummedValue& u) { return u.id == v.id && u.threshold_m == v.threshold_m; });
      if (same == of_a.end()) continue;
      v.value -= same->value;
      differences.push_back(v);
    }
    return differences;
  });
}

}  // namespace cmap
