#pragma once

#include <cmath>

#include "cmap/metrics/metric_inputs.hpp"
#include "cmap/metrics/record.hpp"

namespace cmap {

/// The points whose color is missing, where there are any: what a color metric left out.
inline void add_without_color(Record& record, const MetricInputs& inputs) {
  const MapPair& pair = *inputs.pair;
  if (pair.estimate.n_without_color + pair.reference.n_without_color == 0) return;
  record.add("n_without_color_estimate", pair.estimate.n_without_color);
  record.add("n_without_color_reference", pair.reference.n_without_color);
}

/// The farthest distance of pairs whose colors are compared.
inline Number max_distance_parameter(const MetricOptions& options) {
  return {"max_distance_m", options.color_max_distance_m.value_or(INFINITY)};
}

}  // namespace cmap
