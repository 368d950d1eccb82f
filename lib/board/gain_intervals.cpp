#include "gain_intervals.hpp"

#include <fmt/format.h>

namespace cmap {
namespace {

TableCell cell_for(const ScoreKind& kind, const std::vector<Interval>& differences) {
  const Interval* found = interval_of(differences, kind);
  TableCell cell{std::string(kNoValue), {}, Mark::kNone, ""};
  if (found == nullptr || kind.better.empty()) return cell;
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

std::optional<ScoreTable> gain_interval_table(PairedBootstrap& bootstrap, const ComparisonScores& comparison,
                                              std::size_t baseline) {
  ScoreTable table{"gain-intervals",
                   fmt::format("{} % intervals of these differences", 100.0 * bootstrap.level()),
                   kMetricHeads,
                   {},
                   {},
                   {}};
  for (const ScoreKind& kind : comparison.kinds) table.rows.push_back(metric_row(kind));
  for (std::size_t i = 0; i < comparison.names.size(); ++i) {
    if (i == baseline) continue;
    const std::vector<Interval>& differences = bootstrap.differences(baseline, i);
    if (differences.empty()) return std::nullopt;
    table.value_columns.push_back(comparison.names[i]);
    for (std::size_t row = 0; row < comparison.kinds.size(); ++row) {
      table.rows[row].cells.push_back(cell_for(comparison.kinds[row], differences));
    }
  }
  return table;
}

}  // namespace cmap
