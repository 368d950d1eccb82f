#pragma once

// A metric's record of two maps, or of distances that a test makes up.

#include "cmap/metrics/catalog.hpp"
#include "cmap/metrics/levels.hpp"
#include "cmap/metrics/metric_sums.hpp"
#include "metrics/map_pairs.hpp"

namespace cmap::test {

inline Record measured(const Metric& metric, const MapPair& pair, const MetricOptions& options = {}) {
  MetricInputs inputs(options, pair);
  std::vector<Warning> warnings;
  return measure(metric, inputs, warnings);
}

inline Record measured(const Metric& metric, const Clouds& clouds, const MetricOptions& options = {}) {
  return measured(metric, clouds.pair(), options);
}

/// The same with what the value is worth.
inline Record with_levels(const Metric& metric, const Clouds& clouds, const MetricOptions& options = {}) {
  const MapPair pair = clouds.pair();
  MetricInputs inputs(options, pair);
  std::vector<Warning> warnings;
  Record record = measure(metric, inputs, warnings);
  LevelInputs levels(inputs);
  metric.levels(record, levels, warnings);
  return record;
}

/// Of one map alone.
inline Record measured(const Metric& metric, const PointCloud& cloud, const MetricOptions& options = {}) {
  const IndexedMap map(cloud);
  MetricInputs inputs(options, map);
  std::vector<Warning> warnings;
  return measure(metric, inputs, warnings);
}

/// A number that must be there.
inline double number(const Record& record, std::string_view path) {
  const std::optional<double> found = record.number(path);
  if (!found) ADD_FAILURE() << "no number " << path;
  return found.value_or(-1.0);
}

/// The record of one of the options' thresholds.
inline Record at_threshold(const Record& record, std::size_t index) { return record.list("per_threshold").at(index); }

/// Points at one place whose nearest neighbors are as far as these squares say.
inline MapPair pair_with(const Array<double>& sq_dist_of_estimate, const Array<double>& sq_dist_of_reference) {
  const auto points = [](std::size_t n) { return cloud_of(std::vector<Eigen::Vector3f>(n, {0, 0, 0})); };
  MapPair pair = Clouds{points(sq_dist_of_reference.size()), points(sq_dist_of_estimate.size())}.pair();
  pair.nearest_in_reference.sq_dist = sq_dist_of_estimate;
  pair.nearest_in_estimate.sq_dist = sq_dist_of_reference;
  return pair;
}

inline MapPair pair_with(const Array<double>& sq_dist) { return pair_with(sq_dist, sq_dist); }

/// Squares of distances from 0 to 1, most of them small.
inline Array<double> random_squares(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  Array<double> sq_dist(n);
  for (double& sq : sq_dist) sq = std::pow(uniform(random), 6.0);
  return sq_dist;
}

/// What a sum of 300,001 long doubles may be off by.
inline constexpr double kLongDoubleSum = 300'001 * 0x1p-64;

inline MetricOptions with_thresholds(std::vector<double> thresholds_m, double overlap_distance_m = 1.0) {
  MetricOptions options;
  options.thresholds_m = std::move(thresholds_m);
  options.overlap_distance_m = overlap_distance_m;
  return options;
}

}  // namespace cmap::test
