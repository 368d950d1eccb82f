#pragma once

#include <string>
#include <vector>

#include "cmap/eval/metric_catalog.hpp"

namespace cmap {

/// Whether a metric is a share of points, which people read in percent.
bool is_share(const MetricInfo& metric);

/// Ids and symbols of all metrics.
std::vector<std::string> metric_names();

}  // namespace cmap
