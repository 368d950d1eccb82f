#pragma once

#include <span>

#include "cmap/metrics/metric_inputs.hpp"

namespace cmap {

/// Squared nearest distances of one side.
inline std::span<const double> peer_distances(const MetricInputs& inputs, Side side) {
  return inputs.pairs(side).nearest.sq_dist;
}

}  // namespace cmap
