#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/metrics/metric.hpp"

namespace cmap {

/// The sums of metrics over parts of space (all of it, blocks, or what was observed and the rest): for each column,
/// named "chamfer.estimate.distance", one sum for each part.
struct MetricSums {
  std::size_t n_parts = 1;
  std::map<std::string, std::vector<double>> columns = {};
};

/// Parts of space. Points and voxels of no part given are all in part 0.
struct SpaceParts {
  std::size_t n = 1;
  BothSides<Array<std::uint32_t>> of_slots = {};                             ///< empty: there is one part
  std::function<std::uint32_t(const Eigen::Vector3d& world)> of_voxel = {};  ///< by its center; may add parts
};

/// One pass over either side's points serves all the metrics; each part's sum of a column is exact until it is
/// complete, so that neither threads nor chunks nor the order of points change a bit; sums over parts, and over bands
/// of distances, are added in double in their order. `prepare` of each must have been called.
MetricSums sum_metrics(std::span<const Metric* const> metrics, const MetricInputs& inputs, SpaceParts parts = {});

/// A metric's value, or one of its values.
struct SummedValue {
  std::string_view id;                ///< the metric's
  std::optional<double> threshold_m;  ///< of metrics that have one value for each threshold
  double value;                       ///< NaN where nothing qualified
};

/// The values that a record holds: its own, or those of its thresholds.
std::vector<SummedValue> values_of(std::string_view id, const Record& record);

/// The metrics whose columns are among the sums, ready to be computed for any weights of the parts. The sums must
/// outlive it.
class MetricFormulas {
 public:
  MetricFormulas(const MetricSums& sums, const MetricSettings& settings);

  /// All values, in the order of reports, where part i counts weights[i] times.
  std::vector<SummedValue> values(std::span<const double> weights) const;

 private:
  friend class WholeSums;
  struct Columns {
    std::size_t first = 0, size = 0;
  };
  struct Formula {
    const Metric* metric;
    BothSides<Columns> columns;
  };

  Columns find_columns(const MetricSums& sums, const Metric& source, Side side);
  std::vector<double> totals(std::span<const double> weights) const;
  static PairSums sums_for(const Formula& formula, std::span<const double> totals);

  MetricSettings settings_;
  std::size_t n_parts_;
  std::vector<std::span<const double>> columns_;
  std::vector<Formula> formulas_;
};

/// The sums over all parts, by metric.
class WholeSums {
 public:
  WholeSums(const MetricSums& sums, const MetricSettings& settings);
  /// Empty for a metric that was not summed.
  PairSums of(const Metric& metric) const;

 private:
  MetricFormulas formulas_;
  std::vector<double> totals_;
};

/// What was found of one metric.
struct MetricRecord {
  const MetricInfo* info;
  Record record;
};

/// The metrics over the whole maps: their formulas, and what does not follow from sums. Warnings are appended.
std::vector<MetricRecord> finished_records(std::span<const Metric* const> metrics, const WholeSums& whole,
                                           const MetricInputs& inputs, std::vector<Warning>& warnings);

/// One metric alone: prepared, summed, finished.
Record measure(const Metric& metric, MetricInputs& inputs, std::vector<Warning>& warnings);

}  // namespace cmap
