#include "gain_intervals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/eval/bootstrap.hpp"
#include "cmap/eval/configuration.hpp"
#include "cmap/report/record_json.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// As the intervals of the reports were drawn.
BootstrapOptions options_of(const Json& intervals) {
  BootstrapOptions options;
  options.n_replicates = intervals.at("replicates").get<std::uint64_t>();
  options.level = intervals.at("level").get<double>();
  options.seed = intervals.at("seed").get<std::uint64_t>();
  return options;
}

/// The parameters of the metrics, with which its sums are read.
MetricSettings settings_of(const SavedReport& report) {
  EvaluationOptions options;
  apply_config(options, report.json.at("parameters").dump(), report.name);
  return MetricSettings(options);
}

bool is_of(const Interval& interval, const ScoreKind& kind) {
  const std::string at = interval.threshold_m ? fmt::format("{}", *interval.threshold_m) : "";
  return interval.id == kind.metric && kind.part.empty() && at == kind.at;
}

TableCell cell_for(const ScoreKind& kind, const std::vector<Interval>& differences) {
  const auto found = std::ranges::find_if(differences, [&](const Interval& v) { return is_of(v, kind); });
  TableCell cell{std::string(kNoValue), {}, Mark::kNone, ""};
  if (found == differences.end() || !std::isfinite(found->lower) || kind.better.empty()) return cell;
  const bool lower_is_better = kind.better == "lower";
  const double least = lower_is_better ? -found->upper : found->lower;
  const double most = lower_is_better ? -found->lower : found->upper;
  cell.text = fmt::format("{} to {}", shown_value(kind, least), shown_value(kind, most));
  cell.value = least;
  cell.mark = least > 0.0 ? Mark::kBetter : most < 0.0 ? Mark::kWorse : Mark::kNone;
  cell.note = least > 0.0 || most < 0.0 ? "does not hold 0" : "holds 0: no difference is shown";
  return cell;
}

}  // namespace

std::optional<ScoreTable> gain_interval_table(const std::vector<SavedReport>& reports,
                                              const ComparisonScores& comparison, std::size_t baseline) {
  for (const SavedReport& report : reports) {
    if (!report.json.contains("intervals")) return std::nullopt;
  }
  const Json& base = reports[baseline].json.at("intervals");
  const BlockSums base_blocks = block_sums_from(base.at("blocks"));
  const BootstrapOptions options = options_of(base);
  const MetricSettings settings = settings_of(reports[baseline]);
  ScoreTable table{"gain-intervals",
                   fmt::format("{} % intervals of these differences", 100.0 * options.level),
                   {"metric", "symbol", "", "unit"},
                   {},
                   {},
                   {}};
  for (const ScoreKind& kind : comparison.kinds) {
    table.rows.push_back({{kind.title, kind.symbol, arrow(kind), shown_unit(kind)}, {}});
  }
  for (std::size_t i = 0; i < reports.size(); ++i) {
    if (i == baseline) continue;
    const BlockSums blocks = block_sums_from(reports[i].json.at("intervals").at("blocks"));
    if (blocks.block_m != base_blocks.block_m) return std::nullopt;
    const std::vector<Interval> differences =
        bootstrap_difference(base_blocks, settings, blocks, settings_of(reports[i]), options);
    if (differences.empty()) return std::nullopt;  // sums of an earlier version
    table.value_columns.push_back(comparison.names[i]);
    for (std::size_t row = 0; row < comparison.kinds.size(); ++row) {
      table.rows[row].cells.push_back(cell_for(comparison.kinds[row], differences));
    }
  }
  return table;
}

}  // namespace cmap
