#include "cmap/eval/metric_catalog.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <iterator>

#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"

namespace cmap {
namespace {

constexpr const char* kGroups[]{"default", "color", "color+", "geometry", "distribution", "mme", "density", "all"};

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

std::vector<std::string> names_asked_for(const EvaluationOptions& options) {
  return options.metrics.empty() ? std::vector<std::string>{"default"} : options.metrics;
}

std::vector<std::string_view> ids_of(const std::vector<const MetricInfo*>& metrics) {
  std::vector<std::string_view> ids;
  for (const MetricInfo* metric : metrics) ids.push_back(metric->id);
  return ids;
}

std::vector<std::string> groups_and_metrics() {
  std::vector<std::string> names(std::begin(kGroups), std::end(kGroups));
  std::ranges::copy(metric_names(), std::back_inserter(names));
  return names;
}

/// The metrics of a group, or the one that is called so.
std::vector<const MetricInfo*> metrics_named(const std::string& name) {
  std::vector<const MetricInfo*> metrics;
  for (const MetricInfo& metric : metric_catalog()) {
    if (is_called(metric, name) || is_in_group(metric, name)) metrics.push_back(&metric);
  }
  if (metrics.empty()) {
    throw UsageError(fmt::format("metrics: \"{}\" is unknown{}; groups are {};\nmetrics are {}", name,
                                 did_you_mean(name, groups_and_metrics()), fmt::join(kGroups, ", "),
                                 fmt::join(ids_of(metrics_named("all")), ", ")));
  }
  return metrics;
}

void select(MetricSelection& selection, const MetricInfo& metric, const std::string& name) {
  selection.ids.insert(metric.id);
  if (metric.needs_color && name != "all" && name != "default") selection.color_is_required = true;
}

void refuse_options_of_pairs(const EvaluationOptions& options) {
  const std::pair<const char*, bool> of_pairs[] = {{"align", options.align != "none"},
                                                   {"as", !options.as.empty()},
                                                   {"bootstrap", options.bootstrap > 0},
                                                   {"observed", options.observed != Observed::kNone},
                                                   {"sensitivity", options.sensitivity}};
  for (const auto& [name, is_given] : of_pairs) {
    if (is_given) throw UsageError(fmt::format("{}: needs a reference map, which is missing", name));
  }
}

}  // namespace

const std::vector<MetricInfo>& metric_catalog() {
  static const std::vector<MetricInfo> catalog{
      {"color_distance", "CD", "color distance", "color", "unit RGB", "lower", true, false,
       "Mean color difference (L2 norm of RGB) of every point to its nearest point of the other map, averaged over "
       "both directions."},
      {"color_fidelity", "CF", "color fidelity", "color", "dB", "higher", true, false,
       "-20 log10 of the color distance: the color distance in decibels."},
      {"local_color_recall", "LCR", "local color recall", "color", "1", "higher", true, false,
       "Share of reference points with an estimated point within the radius whose color differs by at most 3 tau. "
       "Never above the coverage, the share with any estimated point there."},
      {"color_consistency", "CCS", "color consistency", "color", "unit RGB^2", "lower", true, false,
       "Mean over the estimate's voxels of the trace of the color covariance: how much colors scatter within a voxel. "
       "One of a single point counts as 0 or is left out, as the parameters say.",
       false},
      {"delta_e", "dE00", "CIEDE2000", "color+", "1", "lower", true, false,
       "Perceived color difference (CIEDE2000) of nearest pairs within the radius of LCR: mean, median and 95th "
       "percentile of both directions."},
      {"color_distance_by_range", "", "color distance by range", "color+", "unit RGB", "lower", true, false,
       "Color distance of the nearest pairs in bins of their distance in space: separates wrong color from wrong "
       "geometry."},
      {"color_distance_exposure_free", "", "color distance, exposure-free", "color+", "unit RGB", "lower", true, false,
       "Color distance after the best gain of every channel on the estimate: what is left without a difference in "
       "exposure."},
      {"color_psnr", "PSNR", "color PSNR", "color+", "dB", "higher", true, false,
       "Peak signal-to-noise ratio of nearest pairs in Y (and Cb, Cr), BT.709, the worse of both directions, as MPEG's "
       "pc_error."},
      {"chamfer", "CD#", "Chamfer distance", "geometry", "m", "lower", false, false,
       "Mean distance of estimated points to the reference plus mean distance of reference points to the estimate."},
      {"accuracy", "AC", "accuracy", "geometry", "m", "lower", false, true,
       "Root mean square of the distances to the reference that are at most the threshold, over the estimated points "
       "that have such."},
      {"fitness", "COM", "fitness (precision)", "geometry", "1", "higher", false, true,
       "Share of estimated points within the threshold of the reference (precision)."},
      {"completeness", "", "completeness (recall)", "geometry", "1", "higher", false, true,
       "Share of reference points within the threshold of the estimate (recall)."},
      {"f_score", "F", "F-score", "geometry", "1", "higher", false, true, "Harmonic mean of fitness and completeness."},
      {"overlap", "Overlap", "overlap", "geometry", "1", "higher", false, false,
       "Share of estimated points within the overlap distance of the reference."},
      {"hausdorff", "", "Hausdorff distance", "geometry", "m", "lower", false, false,
       "Largest distance of any point to the other map; 95th and 99th percentiles beside it."},
      {"rmse", "RMSE", "RMSE", "geometry", "m", "lower", false, false,
       "Root mean square distance of all estimated points to the reference; inlier_rmse: of those within the overlap "
       "distance."},
      {"average_wasserstein", "AWD", "average Wasserstein distance", "distribution", "m", "lower", false, false,
       "Mean over voxels that both maps fill of the 2-Wasserstein distance between the Gaussians of their points."},
      {"spatial_consistency", "SCS", "spatial consistency", "distribution", "1", "lower", false, false,
       "How unevenly the Wasserstein distances are spread: standard deviation over mean among neighboring voxels, "
       "averaged."},
      {"mean_map_entropy", "MME", "mean map entropy", "mme", "nats", "lower", false, false,
       "Mean entropy of the Gaussian of every point's neighborhood, where that is not flat to the rounding of its "
       "coordinates: lower is crisper. Needs no reference.",
       false},
      {"point_spacing", "", "point spacing", "density", "m", "", false, false,
       "Median distance from a point to the nearest other one, copies counted once: the smaller, the denser the map. "
       "Needs no reference.",
       false},
  };
  return catalog;
}

const MetricInfo* find_metric(std::string_view id_or_symbol) {
  const auto metric =
      std::ranges::find_if(metric_catalog(), [&](const MetricInfo& m) { return is_called(m, id_or_symbol); });
  return metric == metric_catalog().end() ? nullptr : &*metric;
}

bool is_share(const MetricInfo& metric) {
  constexpr std::string_view kShares[]{"overlap", "local_color_recall", "fitness", "completeness", "f_score"};
  return std::ranges::count(kShares, metric.id) > 0;
}

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const MetricInfo& metric : metric_catalog()) {
    names.emplace_back(metric.id);
    if (!metric.symbol.empty()) names.emplace_back(metric.symbol);
  }
  return names;
}

MetricSelection select_metrics(const EvaluationOptions& options) {
  MetricSelection selection;
  for (const std::string& name : names_asked_for(options)) {
    for (const MetricInfo* metric : metrics_named(name)) select(selection, *metric, name);
  }
  const bool as_mapeval = std::ranges::count(options.as, "mapeval") > 0;
  selection.needs_gaussians =
      as_mapeval || selection.contains("average_wasserstein") || selection.contains("spatial_consistency");
  selection.needs_neighborhoods = as_mapeval || selection.contains("mean_map_entropy");
  return selection;
}

MetricSelection select_map_metrics(const EvaluationOptions& options) {
  refuse_options_of_pairs(options);
  MetricSelection selection;
  for (const std::string& name : names_asked_for(options)) {
    std::vector<const MetricInfo*> metrics = metrics_named(name == "default" ? "all" : name);
    std::erase_if(metrics, [](const MetricInfo* metric) { return metric->needs_reference; });
    if (metrics.empty()) {
      std::vector<const MetricInfo*> known = metrics_named("all");
      std::erase_if(known, [](const MetricInfo* metric) { return metric->needs_reference; });
      throw UsageError(fmt::format("metrics: {} needs a reference map, which is missing; without one there are {}",
                                   name, fmt::join(ids_of(known), ", ")));
    }
    for (const MetricInfo* metric : metrics) select(selection, *metric, name);
  }
  selection.needs_neighborhoods = selection.contains("mean_map_entropy");
  return selection;
}

}  // namespace cmap
