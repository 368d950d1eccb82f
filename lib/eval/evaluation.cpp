#include "cmap/eval/evaluation.hpp"

#include <algorithm>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "eval/fairness_records.hpp"
#include "eval/metric_records.hpp"
#include "eval/peer_records.hpp"
#include "eval/plausibility.hpp"
#include "eval/preparation.hpp"
#include "eval/stage_clock.hpp"

namespace cmap {
namespace {

void check_color(const PointCloud& reference, const PointCloud& estimate, const MetricSelection& selection,
                 std::vector<Warning>& warnings) {
  if (reference.has_color() && estimate.has_color()) return;
  const bool asked = std::ranges::any_of(
      metric_catalog(), [&](const MetricInfo& metric) { return metric.needs_color && selection.contains(metric.id); });
  if (!asked) return;
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

/// Distance statistics of both directions, for the thresholds and, last, the overlap distance.
void measure_distances(Findings& findings) {
  std::vector<double> thresholds = findings.options.thresholds_m;
  thresholds.push_back(findings.options.overlap_distance_m);
  const auto stats = [&](const NearestPairs& pairs) {
    return distance_stats(pairs.nearest.sq_dist, thresholds, findings.options.overlap_distance_m,
                          {pairs.most_rounding_m(), [&](std::size_t slot) { return pairs.rounding_m(slot); }});
  };
  parallel_tasks({[&] { findings.estimate_to_reference = stats(findings.pair.estimate_to_reference()); },
                  [&] { findings.reference_to_estimate = stats(findings.pair.reference_to_estimate()); }});
}

void check_plausibility(const Findings& f, const CoordinateSteps& steps, std::vector<Warning>& warnings) {
  warn_about_strays(f.pair, f.estimate_to_reference, f.reference_to_estimate, warnings);
  const Bvh &reference = f.pair.reference.index, &estimate = f.pair.estimate.index;
  const SampledSpacing spacing = sampled_spacing(reference);
  warn_about_points("reference", reference.points, spacing, steps.reference, f.options, warnings);
  warn_about_points("estimate", estimate.points, sampled_spacing(estimate), steps.estimate, f.options, warnings);
  const bool by_threshold = std::ranges::any_of(metric_catalog(), [&](const MetricInfo& metric) {
    return metric.per_threshold && f.selection.contains(metric.id);
  });
  if (by_threshold) {
    warn_about_spacing(spacing, f.pair.nearest_in_reference, f.estimate_to_reference, f.options, warnings);
  }
}

void append(std::vector<MetricRecord>& all, std::vector<MetricRecord> some) {
  std::ranges::move(some, std::back_inserter(all));
}

}  // namespace

const MetricRecord* Evaluation::find(std::string_view id) const {
  const auto record = std::ranges::find_if(metrics, [&](const MetricRecord& m) { return m.info->id == id; });
  return record == metrics.end() ? nullptr : &*record;
}

Evaluation evaluate(PointCloud reference, PointCloud estimate, const EvaluationOptions& options,
                    const Eigen::Matrix4d& T_ref_est, const ProgressSink& progress,
                    std::span<const Eigen::Vector3d> sensor_positions) {
  if (options.observed == Observed::kSensor && sensor_positions.empty()) {
    throw UsageError("observed: \"sensor\" needs to know where the sensor was");
  }
  const MetricSelection selection = select_metrics(options);
  std::vector<Warning> warnings;
  std::vector<std::pair<std::string, double>> stage_seconds;
  StageClock clock(stage_seconds, progress);

  drop_missing_colors(reference);
  drop_missing_colors(estimate);
  check_color(reference, estimate, selection, warnings);
  CoordinateSteps steps;
  clock.run("prepare", 0.15,
            [&] { steps = prepare_clouds(reference, estimate, options, selection, T_ref_est, warnings); });
  Evaluation result{
      .options = options, .T_ref_est = T_ref_est, .pair = index_and_pair(reference, estimate, options.index, clock)};

  Findings findings{options, selection, result.pair, {}, {}, {}, {}, sensor_positions};
  clock.run("geometry", 0.7, [&] {
    measure_distances(findings);
    result.overlap = findings.estimate_to_reference.share_within(options.thresholds_m.size());
    result.rmse_m = std::sqrt(findings.estimate_to_reference.mean_sq_m2);
    check_plausibility(findings, steps, warnings);
  });
  if (result.overlap == 0.0) {
    warnings.push_back({"no_overlap", "no estimated point is within the overlap distance of the reference"});
  }
  clock.run("color", 0.75, [&] {
    append(result.metrics, result.pair.has_color() ? color_records(findings, result.recall, warnings)
                                                   : missing_color_records(selection));
  });
  append(result.metrics, geometry_records(findings));

  clock.run("distribution", 0.85, [&] {
    if (selection.needs_gaussians) {
      findings.gaussians = gaussian_pairs(result.pair, options.awd_voxel_m, options.awd_min_points);
    }
    append(result.metrics, distribution_records(findings, warnings));
  });
  clock.run("entropy", 0.9, [&] {
    if (selection.needs_neighborhoods) {
      const auto shapes = [&](const IndexedMap& map) {
        return neighborhood_shapes(map.index, options.mme_radius_m, map.file_step_m);
      };
      findings.neighborhoods = Neighborhoods{shapes(result.pair.reference), shapes(result.pair.estimate)};
    }
    append(result.metrics, entropy_records(findings, warnings));
  });
  clock.run("density", 0.92, [&] { append(result.metrics, density_records(findings, warnings)); });
  clock.run("intervals", 0.93, [&] {
    const LocalColorRecall* recall = result.recall ? &*result.recall : nullptr;
    result.intervals = interval_records(findings, recall, warnings);
    result.unobserved = unobserved_records(findings, recall);
  });
  clock.run("other tools", 0.95, [&] { result.aliases = peer_records(findings, warnings); });

  result.warnings = std::move(warnings);
  result.stage_seconds = std::move(stage_seconds);
  return result;
}

}  // namespace cmap
