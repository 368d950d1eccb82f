#include "cmap/eval/metric_catalog.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

bool is_called(const MetricInfo& metric, std::string_view id_or_symbol) {
  return equal_ignoring_case(metric.id, id_or_symbol) ||
         (!metric.symbol.empty() && equal_ignoring_case(metric.symbol, id_or_symbol));
}

bool is_in_group(const MetricInfo& metric, std::string_view group) {
  if (group == "default")
    return metric.group == "color" || metric.group == "geometry" || metric.group == "distribution";
  return group == "all" || metric.group == group || (group == "color+" && metric.group == "color");
}

}  // namespace

const std::vector<MetricInfo>& metric_catalog() {
  static const std::vector<MetricInfo> catalog{
      {"color_distance", "CD", "color distance", "color", "unit RGB", "lower", true, false},
      {"color_fidelity", "CF", "color fidelity", "color", "dB", "higher", true, false},
      {"local_color_recall", "LCR", "local color recall", "color", "1", "higher", true, false},
      {"color_consistency", "CCS", "color consistency", "color", "unit RGB^2", "lower", true, false},
      {"delta_e", "dE00", "CIEDE2000", "color+", "1", "lower", true, false},
      {"color_distance_by_range", "", "color distance by range", "color+", "unit RGB", "lower", true, false},
      {"color_distance_exposure_free", "", "color distance, exposure-free", "color+", "unit RGB", "lower", true, false},
      {"color_psnr", "PSNR", "color PSNR", "color+", "dB", "higher", true, false},
      {"chamfer", "CD#", "Chamfer distance", "geometry", "m", "lower", false, false},
      {"accuracy", "AC", "accuracy", "geometry", "m", "lower", false, true},
      {"fitness", "COM", "fitness (precision)", "geometry", "1", "higher", false, true},
      {"completeness", "", "completeness (recall)", "geometry", "1", "higher", false, true},
      {"f_score", "F", "F-score", "geometry", "1", "higher", false, true},
      {"overlap", "Overlap", "overlap", "geometry", "1", "higher", false, false},
      {"hausdorff", "", "Hausdorff distance", "geometry", "m", "lower", false, false},
      {"rmse", "RMSE", "RMSE", "geometry", "m", "lower", false, false},
      {"average_wasserstein", "AWD", "average Wasserstein distance", "distribution", "m", "lower", false, false},
      {"spatial_consistency", "SCS", "spatial consistency", "distribution", "1", "lower", false, false},
      {"mean_map_entropy", "MME", "mean map entropy", "mme", "nats", "lower", false, false},
  };
  return catalog;
}

const MetricInfo* find_metric(std::string_view id_or_symbol) {
  const auto metric =
      std::ranges::find_if(metric_catalog(), [&](const MetricInfo& m) { return is_called(m, id_or_symbol); });
  return metric == metric_catalog().end() ? nullptr : &*metric;
}

MetricSelection select_metrics(const EvaluationOptions& options) {
  static const std::vector<std::string> kDefault{"default"};
  MetricSelection selection;
  for (const std::string& name : options.metrics.empty() ? kDefault : options.metrics) {
    bool known = false;
    for (const MetricInfo& metric : metric_catalog()) {
      if (!is_called(metric, name) && !is_in_group(metric, name)) continue;
      known = true;
      selection.ids.insert(metric.id);
      if (metric.needs_color && name != "all" && name != "default") selection.color_is_required = true;
    }
    if (!known) {
      std::vector<std::string_view> ids;
      for (const MetricInfo& metric : metric_catalog()) ids.push_back(metric.id);
      throw UsageError(
          fmt::format("metrics: \"{}\" is unknown; groups are default, color, color+, geometry, distribution, mme, all;"
                      "\nmetrics are {}",
                      name, fmt::join(ids, ", ")));
    }
  }
  const bool as_mapeval = std::ranges::count(options.as, "mapeval") > 0;
  selection.needs_gaussians =
      as_mapeval || selection.contains("average_wasserstein") || selection.contains("spatial_consistency");
  selection.needs_neighborhoods = as_mapeval || selection.contains("mean_map_entropy");
  return selection;
}

}  // namespace cmap
