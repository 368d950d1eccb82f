#include "cmap/eval/metric_catalog.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <iterator>

#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"
#include "cmap/metrics/catalog.hpp"
#include "cmap/peers/peer_tool.hpp"

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
  for (const Metric* metric : metric_list()) {
    if (is_called(metric->info, name) || is_in_group(metric->info, name)) metrics.push_back(&metric->info);
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
  const std::pair<const char*, bool> of_pairs[] = {{"align", options.align.kind != AlignKind::kNone},
                                                   {"as", !options.as.empty()},
                                                   {"bootstrap", options.bootstrap > 0},
                                                   {"observed", options.observed != Observed::kNone},
                                                   {"sensitivity", options.sensitivity}};
  for (const auto& [name, is_given] : of_pairs) {
    if (is_given) throw UsageError(fmt::format("{}: needs a reference map, which is missing", name));
  }
}

}  // namespace

const MetricInfo* find_metric(std::string_view id_or_symbol) {
  for (const Metric* metric : metric_list()) {
    if (is_called(metric->info, id_or_symbol)) return &metric->info;
  }
  return nullptr;
}

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const Metric* metric : metric_list()) {
    names.emplace_back(metric->info.id);
    if (!metric->info.symbol.empty()) names.emplace_back(metric->info.symbol);
  }
  return names;
}

MetricSelection select_metrics(const EvaluationOptions& options) {
  MetricSelection selection;
  for (const std::string& name : names_asked_for(options)) {
    for (const MetricInfo* metric : metrics_named(name)) select(selection, *metric, name);
  }
  const auto contains = [&](const Metric& metric) { return selection.contains(metric.info.id); };
  const bool for_a_tool = std::ranges::any_of(options.as, &PeerTool::reads_gaussians);
  selection.needs_gaussians =
      for_a_tool || contains(catalog::average_wasserstein) || contains(catalog::spatial_consistency);
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
  return selection;
}

}  // namespace cmap
