#include "comparison_scores.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cmap/core/error.hpp"
#include "cmap/eval/metric_catalog.hpp"
#include "cmap/report/table_text.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

bool is_chosen(const MetricSelection* selection, const ScoreKind& kind) {
  return selection == nullptr || selection->contains(kind.metric);
}

}  // namespace

ComparisonScores scores_to_compare(const std::vector<SavedReport>& reports, const ComparisonOptions& options) {
  EvaluationOptions wanted;
  wanted.metrics = options.metrics;
  const MetricSelection selection = select_metrics(wanted);
  ComparisonScores comparison;
  for (const SavedReport& report : reports) {
    comparison.names.push_back(one_line(report.name));
    comparison.scores.push_back(scores_of(report.json));
  }
  for (const ScoreKind& kind : kinds_of(comparison.scores)) {
    if (is_chosen(options.metrics.empty() ? nullptr : &selection, kind)) comparison.kinds.push_back(kind);
  }
  if (comparison.kinds.empty()) {
    throw UsageError(fmt::format("metrics: no report has any of {}", fmt::join(options.metrics, ", ")));
  }
  return comparison;
}

const std::vector<std::string> kMetricHeads{"metric", "symbol", "", "unit"};

TableRow metric_row(const ScoreKind& kind) { return {{kind.title, kind.symbol, arrow(kind), shown_unit(kind)}, {}}; }

std::string shown_value(const ScoreKind& kind, const std::optional<double>& value) {
  const Json json = value ? Json(*value) : Json(nullptr);
  return kind.share ? hundredths(json) : digits(json);
}

std::string shown_unit(const ScoreKind& kind) { return kind.share ? "%" : kind.unit == "1" ? "" : kind.unit; }

std::string arrow(const ScoreKind& kind) { return kind.better == "lower" ? "↓" : kind.better == "higher" ? "↑" : ""; }

}  // namespace cmap
