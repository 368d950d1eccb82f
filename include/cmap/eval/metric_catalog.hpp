#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/eval/options.hpp"

namespace cmap {

/// What is fixed about a metric: METRICS.md in one table.
struct MetricInfo {
  std::string_view id;
  std::string_view symbol;  ///< the paper's, or empty
  std::string_view title;   ///< for people
  std::string_view group;   ///< color, color+, geometry, distribution, mme, density
  std::string_view unit;
  std::string_view better;  ///< "lower", "higher"; empty where neither is
  bool needs_color;
  bool per_threshold;           ///< has one value for each of `thresholds`
  std::string_view definition;  ///< a sentence or two for people
  bool needs_reference = true;  ///< else it has a value for a map alone, and of a pair for each map
};

/// All metrics in the order of reports.
const std::vector<MetricInfo>& metric_catalog();

/// By id or symbol, whatever the case; nullptr if there is none.
const MetricInfo* find_metric(std::string_view id_or_symbol);

/// Which metrics the options ask for, and what these are computed from.
struct MetricSelection {
  std::set<std::string_view> ids;
  bool color_is_required = false;    ///< a color group or metric was named
  bool needs_gaussians = false;      ///< AWD, SCS or MapEval's record
  bool needs_neighborhoods = false;  ///< MME or MapEval's record
  bool contains(std::string_view id) const { return ids.contains(id); }
};

/// Groups: color, color+ (color and what goes beyond the paper), geometry, distribution, mme, density, all; default is
/// color, geometry and distribution as far as the maps allow.
/// Throws UsageError for an unknown name.
MetricSelection select_metrics(const EvaluationOptions& options);

/// The same for one map without a reference: of each group what needs none; default is all of that.
/// Throws UsageError also for metrics, groups and other options (align, as, bootstrap, observed, sensitivity) that mean
/// nothing without a reference.
MetricSelection select_map_metrics(const EvaluationOptions& options);

/// Whether a metric is a share of points, which people read in percent.
bool is_share(const MetricInfo& metric);

/// Ids and symbols of all metrics.
std::vector<std::string> metric_names();

}  // namespace cmap
