#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <vector>

#include "cmap/core/warning.hpp"
#include "cmap/geometry/order_statistics.hpp"
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

/// Quantiles of the values that are not NaN; NaN of none.
inline std::vector<double> quantiles_of_numbers(std::span<const double> values, std::span<const double> shares) {
  std::vector<double> numbers;
  std::ranges::copy_if(values, std::back_inserter(numbers), [](double v) { return !std::isnan(v); });
  return quantiles(numbers, shares);
}

/// Said once, whichever of the color distances is asked for.
inline void warn_of_no_pairs(const Record& record, std::vector<Warning>& warnings) {
  constexpr const char* kId = "color_distance_no_pairs";
  if (!std::isnan(*record.value) || std::ranges::count(warnings, kId, &Warning::id) > 0) return;
  warnings.push_back({kId,
                      "no pair of nearest points counts in both directions (both need a color, within "
                      "color-max-distance): no color distance"});
}

/// The farthest distance of pairs whose colors are compared.
inline Number max_distance_parameter(const MetricOptions& options) {
  return {"max_distance_m", options.color_max_distance_m.value_or(INFINITY)};
}

}  // namespace cmap
