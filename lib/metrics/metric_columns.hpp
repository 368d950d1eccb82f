#pragma once

#include <fmt/format.h>

#include <string>

#include "cmap/metrics/metric.hpp"

namespace cmap {

/// The metric whose columns these sums are.
inline const Metric& summed(const Metric& metric) { return metric.sums_of == nullptr ? metric : *metric.sums_of; }

inline bool has_side(const Metric& metric, Side side) {
  return metric.sides == Sides::kBoth || (metric.sides == Sides::kEstimate) == (side == Side::kEstimate);
}

inline std::string column_name(const Metric& metric, Side side, const std::string& column) {
  return fmt::format("{}.{}.{}", metric.info.id, side == Side::kEstimate ? "estimate" : "reference", column);
}

}  // namespace cmap
