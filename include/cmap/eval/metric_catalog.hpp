#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/eval/options.hpp"
#include "cmap/metrics/metric.hpp"

namespace cmap {

/// By id or symbol, whatever the case; nullptr if there is none.
const MetricInfo* find_metric(std::string_view id_or_symbol);

/// Which metrics the options ask for, and what these are computed from.
struct MetricSelection {
  std::set<std::string_view> ids;
  bool color_is_required = false;  ///< a color group or metric was named
  bool needs_gaussians = false;    ///< for AWD, SCS or another tool's numbers
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

/// Ids and symbols of all metrics.
std::vector<std::string> metric_names();

}  // namespace cmap
