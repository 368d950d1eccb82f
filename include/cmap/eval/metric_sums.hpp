#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cmap {

/// Sums over parts of space (blocks, or the observed part and the rest) from which every metric that is a mean or a
/// share follows: for each column, one sum for each part. Columns are named "estimate.distance", "reference.n<=0.1";
/// FORMATS of reports keep them by these names.
struct MetricSums {
  std::size_t n_parts = 0;
  std::map<std::string, std::vector<double>> columns;

  std::vector<double>& column(const std::string& name) {
    return columns.try_emplace(name, std::vector<double>(n_parts)).first->second;
  }
};

/// Sums over all parts that were chosen, by column.
using MetricTotals = std::map<std::string, double>;

/// Each part counted weights[part] times. `weights` has n_parts entries.
MetricTotals totals_of(const MetricSums& sums, std::span<const double> weights);

/// A metric's value computed from sums, NaN where nothing qualified.
struct SummedValue {
  std::string_view id;                ///< of the catalog
  std::optional<double> threshold_m;  ///< of metrics that have one value for each threshold
  double value;
};

/// All metrics that the columns give, in the catalog's order: the values of the report, up to the order of summation.
std::vector<SummedValue> values_of(const MetricTotals& totals);

}  // namespace cmap
