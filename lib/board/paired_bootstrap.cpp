#include "paired_bootstrap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cmap/eval/configuration.hpp"
#include "cmap/report/record_json.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// As the intervals of the report were drawn.
BootstrapOptions options_of(const Json& intervals) {
  BootstrapOptions options;
  options.n_replicates = intervals.at("replicates").get<std::uint64_t>();
  options.level = intervals.at("level").get<double>();
  options.seed = intervals.at("seed").get<std::uint64_t>();
  return options;
}

/// The parameters of the metrics, with which its sums are read.
MetricSettings settings_of(const Json& report) {
  EvaluationOptions options;
  apply_config(options, report.at("parameters").dump(), "parameters");
  return MetricSettings(options);
}

bool is_of(const Interval& interval, const ScoreKind& kind) {
  const std::string at = interval.threshold_m ? fmt::format("{}", *interval.threshold_m) : "";
  return interval.id == kind.metric && kind.part.empty() && at == kind.at;
}

}  // namespace

PairedBootstrap::PairedBootstrap(std::vector<const Json*> reports) : reports_(std::move(reports)) {}

bool PairedBootstrap::has_blocks(std::size_t i) const {
  return reports_[i] != nullptr && reports_[i]->contains("intervals");
}

bool PairedBootstrap::lacks_blocks(std::size_t i) const {
  return !has_blocks(i) && (reports_[i] == nullptr || reports_[i]->at("inputs").contains("reference"));
}

double PairedBootstrap::level() const {
  for (std::size_t i = 0; i < reports_.size(); ++i) {
    if (has_blocks(i)) return options_of(reports_[i]->at("intervals")).level;
  }
  return BootstrapOptions{}.level;
}

const PairedBootstrap::Blocks& PairedBootstrap::blocks_of(std::size_t i) {
  const auto found = blocks_.find(i);
  if (found != blocks_.end()) return found->second;
  const Json& intervals = reports_[i]->at("intervals");
  Blocks blocks{block_sums_from(intervals.at("blocks")), settings_of(*reports_[i]), options_of(intervals)};
  return blocks_.emplace(i, std::move(blocks)).first->second;
}

std::vector<Interval> PairedBootstrap::drawn(std::size_t a, std::size_t b) {
  if (!has_blocks(a) || !has_blocks(b)) return {};
  const Blocks &of_a = blocks_of(a), &of_b = blocks_of(b);
  if (of_a.sums.block_m != of_b.sums.block_m) return {};
  return bootstrap_difference(of_a.sums, of_a.settings, of_b.sums, of_b.settings, of_a.options);
}

const std::vector<Interval>& PairedBootstrap::differences(std::size_t a, std::size_t b) {
  const auto found = differences_.find({a, b});
  return found != differences_.end() ? found->second : differences_[{a, b}] = drawn(a, b);
}

std::size_t PairedBootstrap::n_blocks(std::size_t a, std::size_t b) {
  std::vector<std::array<std::int64_t, 3>> keys;
  std::ranges::set_union(blocks_of(a).sums.keys, blocks_of(b).sums.keys, std::back_inserter(keys));
  return keys.size();
}

const Interval* interval_of(const std::vector<Interval>& intervals, const ScoreKind& kind) {
  const auto found = std::ranges::find_if(intervals, [&](const Interval& v) { return is_of(v, kind); });
  return found == intervals.end() || !std::isfinite(found->lower) ? nullptr : &*found;
}

}  // namespace cmap
