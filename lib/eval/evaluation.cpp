#include "cmap/eval/evaluation.hpp"

#include <algorithm>
#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/metrics/catalog.hpp"
#include "cmap/metrics/levels.hpp"
#include "cmap/peers/peer_tool.hpp"
#include "measurement.hpp"
#include "plausibility.hpp"
#include "preparation.hpp"
#include "stage_clock.hpp"

namespace cmap {
namespace {

void check_color(const PointCloud& reference, const PointCloud& estimate, const MetricSelection& selection,
                 std::vector<Warning>& warnings) {
  if (reference.has_color() && estimate.has_color()) return;
  const auto needs_color = [](const Metric* metric) { return metric->info.needs_color; };
  if (std::ranges::none_of(selected_metrics(selection, true), needs_color)) return;
  const char* which = reference.has_color()  ? "the estimate has"
                      : estimate.has_color() ? "the reference has"
                                             : "both maps have";
  const std::string message = std::string(which) + " no color, which color metrics need";
  if (selection.color_is_required) throw UnsupportedError(message);
  warnings.push_back({"no_color", message + ": they are null"});
}

MapPair index_and_pair(PointCloud& reference, PointCloud& estimate, IndexKind index, StageClock& clock) {
  std::optional<IndexedMap> indexed_reference, indexed_estimate;
  clock.run("index", 0.2, [&] {
    indexed_reference.emplace(reference);
    reference = {};  // its memory is needed
    indexed_estimate.emplace(estimate);
    estimate = {};
  });
  MapPair pair{std::move(*indexed_reference), std::move(*indexed_estimate), {}, {}};
  clock.run("nearest neighbors", 0.4, [&] {
    pair.nearest_in_reference = find_nearest(index, pair.reference.index, pair.estimate.index.points);
    pair.nearest_in_estimate = find_nearest(index, pair.estimate.index, pair.reference.index.points);
  });
  return pair;
}

/// The metrics to sum: those, and what an evaluation tells in any case.
std::vector<const Metric*> with_basics(std::vector<const Metric*> metrics) {
  for (const Metric* basic : {&catalog::chamfer, &catalog::fitness, &catalog::rmse}) metrics.push_back(basic);
  return metrics;
}

void check_plausibility(const MetricInputs& inputs, const WholeSums& sums, const CoordinateSteps& steps,
                        const EvaluationOptions& options, const MetricSelection& selection,
                        std::vector<Warning>& warnings) {
  const MapPair& pair = *inputs.pair;
  const PairSums distances = sums.of(catalog::chamfer);
  warn_about_strays(pair, mean_distances(distances.estimate), mean_distances(distances.reference), warnings);
  const Bvh &reference = pair.reference.index, &estimate = pair.estimate.index;
  const SampledSpacing spacing = sampled_spacing(reference);
  warn_about_points("reference", reference.points, spacing, steps.reference, options, warnings);
  warn_about_points("estimate", estimate.points, sampled_spacing(estimate), steps.estimate, options, warnings);
  const auto by_threshold = [](const Metric* metric) { return metric->info.per_threshold; };
  if (std::ranges::none_of(selected_metrics(selection, true), by_threshold)) return;
  const Record fitness = catalog::fitness.value(sums.of(catalog::fitness), inputs.settings);
  warn_about_spacing(spacing, pair.nearest_in_reference, fitness.list("per_threshold"), warnings);
}

/// Whether tools that know no points without color can be run.
bool every_point_has_color(const MapPair& pair) {
  return pair.has_color() && pair.reference.n_without_color + pair.estimate.n_without_color == 0;
}

/// What the tools of options.as would print.
std::vector<PeerRecord> peer_records(MetricInputs& inputs, const EvaluationOptions& options,
                                     std::vector<Warning>& warnings) {
  const PeerOptions peer_options{tanks_and_temples_tau_m(options), options.crop};
  std::vector<PeerRecord> records;
  for (const PeerTool* tool : options.as) {
    PeerRecord& peer = records.emplace_back(PeerRecord{std::string(tool->name), {}});
    if (tool->no_color.empty() || every_point_has_color(*inputs.pair)) {
      peer.record = tool->record(inputs, peer_options);
    } else {
      warnings.push_back({std::string(tool->no_color_id), std::string(tool->no_color)});
    }
  }
  return records;
}

/// What is said beside the metrics, where the options ask for it.
void add_fairness(Evaluation& result, MetricInputs& inputs, std::span<const Metric* const> metrics,
                  std::span<const Eigen::Vector3d> sensor_positions, std::vector<Warning>& warnings) {
  const EvaluationOptions& options = result.options;
  if (options.bootstrap > 0) result.intervals = intervals_of(inputs, metrics, options, warnings);
  if (options.observed != Observed::kNone) {
    result.unobserved = observed_part(inputs, metrics, options, sensor_positions);
  }
}

}  // namespace

EvaluatedPair evaluate(PointCloud reference, PointCloud estimate, const EvaluationOptions& options,
                       const Eigen::Matrix4d& T_ref_est, const Execution& execution,
                       std::span<const Eigen::Vector3d> sensor_positions) {
  const ExecutionScope scope(execution);
  if (options.observed == Observed::kSensor && sensor_positions.empty()) {
    throw UsageError("observed: \"sensor\" needs to know where the sensor was");
  }
  const MetricSelection selection = select_metrics(options);
  std::vector<Warning> warnings;
  std::vector<std::pair<std::string, double>> stage_seconds;
  StageClock clock(stage_seconds);

  drop_missing_colors(reference);
  drop_missing_colors(estimate);
  check_color(reference, estimate, selection, warnings);
  CoordinateSteps steps;
  clock.run("prepare", 0.15,
            [&] { steps = prepare_clouds(reference, estimate, options, selection, T_ref_est, warnings); });
  // On its own: g++ 12 destroys the base twice where the initializer of a member behind it throws.
  MapPair pair = index_and_pair(reference, estimate, options.index, clock);
  EvaluatedPair result{{.options = options, .T_ref_est = T_ref_est}, std::move(pair)};

  MetricInputs inputs(options, result.pair);
  const std::vector<const Metric*> metrics = selected_metrics(selection, result.pair.has_color());
  find_fields(metrics, inputs, clock);
  clock.run("sums", 0.85, [&] {
    const WholeSums sums(sum_metrics(with_basics(metrics), inputs), inputs.settings);
    result.overlap = *catalog::overlap.value(sums.of(catalog::overlap), inputs.settings).value;
    result.rmse_m = *catalog::rmse.value(sums.of(catalog::rmse), inputs.settings).value;
    check_plausibility(inputs, sums, steps, options, selection, warnings);
    if (result.overlap == 0.0) {
      warnings.push_back({"no_overlap", "no estimated point is within the overlap distance of the reference"});
    }
    std::vector<MetricRecord> records = finished_records(metrics, sums, inputs, warnings);
    warn_of_phases(records, warnings);
    if (!options.no_levels) {
      LevelInputs levels(inputs);
      add_levels(metrics, records, levels, warnings);
    }
    result.metrics = with_missing(selection, std::move(records));
  });
  clock.run("intervals", 0.93, [&] { add_fairness(result, inputs, metrics, sensor_positions, warnings); });
  clock.run("other tools", 0.95, [&] { result.peers = peer_records(inputs, options, warnings); });

  result.recall = std::move(inputs.recall);
  result.warnings = std::move(warnings);
  result.stage_seconds = std::move(stage_seconds);
  return result;
}

}  // namespace cmap
