#pragma once

#include <string>
#include <vector>

#include "cmap/metrics/metric.hpp"

namespace cmap {

/// Names of columns of which there is one for each band of distances: "n 0.05..0.1", and at last "n 1..".
std::vector<std::string> band_columns(const MetricSettings& settings, const std::string& name);

/// Over all bands.
double sum_of_bands(std::span<const double> sums);

/// Over the bands within a threshold: of a metric whose columns from `first` on are one for each band.
double sum_within(std::span<const double> sums, const MetricSettings& settings, double threshold_m,
                  std::size_t first = 0);

/// The share of one side's points within a threshold, from the counts of metric `fitness`.
double share_within(std::span<const double> counts, const MetricSettings& settings, double threshold_m);

/// {per_threshold: [{threshold_m, value, n}], n_points}: those shares.
Record shares_record(std::span<const double> counts, const MetricSettings& settings);

/// Adds to each threshold the share of the reference's points that have another one of it within.
void add_share_floors(Record& record, LevelInputs& levels);

}  // namespace cmap
