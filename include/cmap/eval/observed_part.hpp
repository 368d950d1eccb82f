#pragma once

#include <cstdint>
#include <vector>

#include "cmap/eval/options.hpp"
#include "cmap/metrics/metric_sums.hpp"

namespace cmap {

/// The points of one map that the other could not have seen.
struct UnobservedPoints {
  std::uint64_t n = 0;
  double share = 0.0;
};

/// The metrics over those points alone that the other map could have seen.
struct ObservedPart {
  Observed method = Observed::kNone;
  double column_m = 0.0;          ///< of the columns in which the other map has points
  std::uint64_t n_positions = 0;  ///< of the sensor
  BothSides<UnobservedPoints> left_out = {};
  std::vector<SummedValue> values = {};  ///< of the metrics that are sums
};

}  // namespace cmap
