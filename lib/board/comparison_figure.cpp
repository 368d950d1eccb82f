#include <fmt/format.h>

#include <algorithm>

#include "charts.hpp"
#include "cmap/core/error.hpp"
#include "cmap/report/figure_module.hpp"
#include "comparison_scores.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

bool is_svg(const std::filesystem::path& name) { return name.extension() == ".svg" || name.extension() == ".SVG"; }

std::string title_with_unit(const std::string& title, const ScoreKind& kind) {
  const std::string unit = shown_unit(kind);
  return fmt::format("{} {}{}", title, arrow(kind), unit.empty() ? "" : fmt::format(" [{}]", unit));
}

std::vector<BarChart> bar_charts(const ComparisonScores& comparison) {
  std::vector<BarChart> charts;
  for (const ScoreKind& kind : comparison.kinds) {
    if (!kind.at.empty()) continue;  // these are curves
    BarChart& chart = charts.emplace_back(BarChart{title_with_unit(kind.title, kind), {}, {}});
    for (const auto& scores : comparison.scores) {
      chart.values.push_back(value_of(scores, kind));
      chart.texts.push_back(shown_value(kind, chart.values.back()));
    }
  }
  return charts;
}

/// Values of a curve in the unit of the tables.
std::optional<double> plotted(const ScoreKind& kind, const std::optional<double>& value) {
  return value && kind.share ? std::optional(100.0 * *value) : value;
}

/// A metric against its thresholds, from the smallest.
CurveChart threshold_curve(const ComparisonScores& comparison, std::vector<ScoreKind> kinds) {
  std::ranges::sort(kinds, {}, [](const ScoreKind& kind) { return std::stod(kind.at); });
  const ScoreKind& any = kinds.front();
  CurveChart chart{title_with_unit(any.title.substr(0, any.title.find(" <=")), any), "threshold [m]", {}, {}};
  for (const ScoreKind& kind : kinds) chart.x.push_back(std::stod(kind.at));
  for (const auto& scores : comparison.scores) {
    auto& values = chart.y.emplace_back();
    for (const ScoreKind& kind : kinds) values.push_back(plotted(kind, value_of(scores, kind)));
  }
  return chart;
}

/// Local color recall against tau, where a report has the curve.
std::optional<CurveChart> recall_curve(const std::vector<SavedReport>& reports) {
  const Json::json_pointer place("/metrics/local_color_recall/curve");
  CurveChart chart{"local color recall ↑ [%]", "tau", {}, {}};
  for (const SavedReport& report : reports) {
    if (!report.json.contains(place)) continue;
    if (chart.x.empty()) chart.x = report.json.at(place).at("tau").get<std::vector<double>>();
  }
  if (chart.x.empty()) return std::nullopt;
  for (const SavedReport& report : reports) {
    auto& values = chart.y.emplace_back(chart.x.size());
    if (!report.json.contains(place)) continue;
    const auto shares = report.json.at(place).at("value").get<std::vector<double>>();
    for (std::size_t i = 0; i < std::min(shares.size(), values.size()); ++i) values[i] = 100.0 * shares[i];
  }
  return chart;
}

std::vector<CurveChart> curve_charts(const std::vector<SavedReport>& reports, const ComparisonScores& comparison) {
  std::vector<CurveChart> charts;
  for (auto first = comparison.kinds.begin(); first != comparison.kinds.end();) {
    const auto last = std::find_if(first, comparison.kinds.end(),
                                   [&](const ScoreKind& kind) { return kind.metric != first->metric; });
    const bool has_thresholds = !first->at.empty() && first->metric != "color_distance_by_range";
    if (has_thresholds) charts.push_back(threshold_curve(comparison, {first, last}));
    if (first->metric == "local_color_recall") {
      if (auto recall = recall_curve(reports)) charts.push_back(std::move(*recall));
    }
    first = last;
  }
  return charts;
}

}  // namespace

void check_figure_name(const std::filesystem::path& name) {
  if (is_svg(name)) return;
  try {
    FigureModule().check_name(name);
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}; a chart can also be .svg", error.what()));
  } catch (const UnsupportedError& error) {
    throw UnsupportedError(fmt::format("{}; a chart can also be .svg", error.what()));
  }
}

void write_comparison_figure(const std::vector<SavedReport>& reports, const ComparisonOptions& options,
                             const std::filesystem::path& name, OutputFile& file) {
  const ComparisonScores comparison = scores_to_compare(reports, options);
  const Drawing drawing = draw_charts(comparison.names, bar_charts(comparison), curve_charts(reports, comparison));
  if (is_svg(name)) {
    file.write(svg(drawing));
  } else {
    FigureModule().write(drawing, name, file);
  }
}

}  // namespace cmap
