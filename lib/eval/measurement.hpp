#pragma once

#include <span>
#include <vector>

#include "cmap/eval/evaluation.hpp"
#include "stage_clock.hpp"

namespace cmap {

/// The selected metrics; without color those that need none.
std::vector<const Metric*> selected_metrics(const MetricSelection& selection, bool with_color);

/// Makes the fields that the metrics read, a timed stage a group of metrics.
void find_fields(std::span<const Metric* const> metrics, MetricInputs& inputs, StageClock& clock);

/// The records of all selected metrics: null for those that need color where there is none.
MetricRecords with_missing(const MetricSelection& selection, std::vector<MetricRecord> computed);

/// Confidence intervals of the selected metrics; few blocks give a warning.
Intervals intervals_of(const MetricInputs& inputs, std::span<const Metric* const> metrics,
                       const EvaluationOptions& options, std::vector<Warning>& warnings);

/// The selected metrics over what the other map could have seen: estimated points by where the reference is, reference
/// points by what the estimate's sensor saw from its positions where the options say so, else by where the estimate is.
ObservedPart observed_part(const MetricInputs& inputs, std::span<const Metric* const> metrics,
                           const EvaluationOptions& options, std::span<const Eigen::Vector3d> sensor_positions);

}  // namespace cmap
