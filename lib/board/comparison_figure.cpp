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

/// The spread over the grid's phases, else the interval of the report.
std::optional<Range> range_of(const Json& report, const std::vector<Score>& scores, const ScoreKind& kind) {
  const Score* score = score_of(scores, kind);
  if (score != nullptr && score->phases) return Range{score->phases->min, score->phases->max};
  const Json::json_pointer lower(fmt::format("/intervals/metrics/{}/lower", kind.metric)),
      upper(fmt::format("/intervals/metrics/{}/upper", kind.metric));
  if (!kind.part.empty() || !report.contains(lower) || !report.at(lower).is_number()) return std::nullopt;
  return Range{report.at(lower).get<double>(), report.at(upper).get<double>()};
}

std::vector<BarChart> bar_charts(const std::vector<SavedReport>& reports, const ComparisonScores& comparison) {
  std::vector<BarChart> charts;
  for (const ScoreKind& kind : comparison.kinds) {
    if (!kind.at.empty()) continue;  // these are curves
    BarChart& chart = charts.emplace_back(BarChart{title_with_unit(kind.title, kind), {}, {}});
    for (std::size_t i = 0; i < reports.size(); ++i) {
      chart.values.push_back(value_of(comparison.scores[i], kind));
      chart.texts.push_back(shown_value(kind, chart.values.back()));
      chart.ranges.push_back(range_of(reports[i].json, comparison.scores[i], kind));
    }
  }
  return charts;
}

/// What the lines over the bars are, where there are any.
std::string note_on(const std::vector<BarChart>& charts) {
  const auto has_range = [](const BarChart& chart) {
    return std::ranges::any_of(chart.ranges, [](const auto& range) { return range.has_value(); });
  };
  return std::ranges::any_of(charts, has_range) ? "Lines over bars: from the least to the greatest over the grid's "
                                                  "phases, else the report's interval (--bootstrap)"
                                                : "";
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

/// One list of the recall's curve in percent, by report; empty where no report has it.
CurveChart::Curves recall_curves(const std::vector<SavedReport>& reports, const char* name, std::size_t n) {
  const Json::json_pointer place(fmt::format("/metrics/local_color_recall/curve/{}", name));
  CurveChart::Curves curves;
  bool is_there = false;
  for (const SavedReport& report : reports) {
    auto& values = curves.emplace_back(n);
    if (!report.json.contains(place)) continue;
    is_there = true;
    const Json& shares = report.json.at(place);
    for (std::size_t i = 0; i < std::min(shares.size(), n); ++i) {
      if (shares[i].is_number()) values[i] = 100.0 * shares[i].get<double>();
    }
  }
  return is_there ? curves : CurveChart::Curves{};
}

/// Local color recall against tau, where a report has the curve.
std::optional<CurveChart> recall_curve(const std::vector<SavedReport>& reports) {
  const Json::json_pointer place("/metrics/local_color_recall/curve/tau");
  const auto first = std::ranges::find_if(reports, [&](const SavedReport& r) { return r.json.contains(place); });
  if (first == reports.end()) return std::nullopt;
  CurveChart chart{"local color recall ↑ [%]", "tau", first->json.at(place).get<std::vector<double>>(), {}};
  chart.y = recall_curves(reports, "value", chart.x.size());
  chart.dashed = recall_curves(reports, "chance", chart.x.size());
  if (!chart.dashed.empty()) chart.title += ", dashed: by chance";
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
  const std::vector<BarChart> bars = bar_charts(reports, comparison);
  const Drawing drawing = draw_charts(comparison.names, bars, curve_charts(reports, comparison), note_on(bars));
  if (is_svg(name)) {
    file.write(svg(drawing));
  } else {
    FigureModule().write(drawing, name, file);
  }
}

}  // namespace cmap
