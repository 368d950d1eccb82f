#include "cmap/eval/protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "cmap/align/align.hpp"
#include "cmap/align/tanks_and_temples.hpp"
#include "cmap/align/trajectory.hpp"
#include "cmap/align/trust.hpp"
#include "cmap/core/error.hpp"
#include "cmap/eval/sensitivity.hpp"

namespace cmap {
namespace {

Alignment align_by_trajectories(const EvaluationOptions& options, const ProtocolInputs& inputs) {
  if (!inputs.reference_trajectory || !inputs.estimate_trajectory) {
    throw UsageError("align: \"trajectory\" needs the trajectories of both maps");
  }
  TrajectoryOptions how;
  how.fit = options.trajectory_fit;
  how.pairing = options.trajectory_pairing;
  how.max_gap_s = options.trajectory_max_gap_s;
  how.time_offset_s = options.trajectory_time_offset_s.value_or(0.0);
  return align_trajectories(*inputs.estimate_trajectory, *inputs.reference_trajectory, how);
}

Alignment align_estimate(const PointCloud& reference, const PointCloud& estimate, const EvaluationOptions& options,
                         const ProtocolInputs& inputs) {
  if (options.align.kind == AlignKind::kTrajectory) return align_by_trajectories(options, inputs);
  if (options.align.kind == AlignKind::kTanksAndTemples) {
    TanksAndTemplesOptions tanks;
    tanks.tau_m = tanks_and_temples_tau_m(options);
    tanks.crop = options.crop;
    return tanks_and_temples(estimate, reference, inputs.T_initial, tanks).alignment;
  }
  AlignOptions how;
  how.T_initial = inputs.T_initial;
  how.voxel_m = options.align_voxel_m;
  how.max_distance_m = options.align_distance_m;
  how.with_scale = options.align_scale;
  how.finest_m = *std::ranges::min_element(options.thresholds_m);
  return align(estimate, reference, *options.align.registration, how);
}

/// What is weaker than the largest threshold would decide the scores.
TrustRule trust_rule(const EvaluationOptions& options) {
  return {.allow_unconverged = options.allow_unconverged,
          .largest_error_m = *std::ranges::max_element(options.thresholds_m)};
}

/// Low values say that the scores may measure the alignment more than the map.
void warn_of_alignment(const Alignment& alignment, std::vector<Warning>& warnings) {
  constexpr double kLowOverlap = 0.3;
  for (const std::string& message : alignment.warnings) warnings.push_back({"alignment", message});
  if (alignment.overlap < kLowOverlap) {
    warnings.push_back({"alignment_low_overlap",
                        fmt::format("only {:.1f} % of the estimate met the reference in the alignment: do not trust it",
                                    100.0 * alignment.overlap)});
  }
}

/// The plain metrics and nothing beside.
EvaluationOptions plain(EvaluationOptions options) {
  options.bootstrap = 0;
  options.observed = Observed::kNone;
  options.as.clear();
  options.no_levels = true;
  options.grid_phases = GridPhases::kOne;
  options.ccs_phases = false;
  return options;
}

}  // namespace

EvaluatedPair evaluate_by_protocol(PointCloud reference, PointCloud estimate, const EvaluationOptions& options,
                                   const ProtocolInputs& inputs, const Execution& execution) {
  const ExecutionScope scope(execution);
  const Execution same_sink{.progress = execution.progress};
  std::vector<std::pair<std::string, double>> stages;
  const auto timed = [&](const char* stage, double done, auto&& work) {
    report_progress(stage, done);
    const auto start = std::chrono::steady_clock::now();
    work();
    stages.emplace_back(stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  };
  Eigen::Matrix4d T_ref_est = inputs.T_initial;
  std::optional<Alignment> alignment;
  MetricRecords before;
  if (options.align.kind != AlignKind::kNone) {
    timed("scores before", 0.05, [&] { before = evaluate(reference, estimate, plain(options), T_ref_est).metrics; });
    timed("align", 0.1, [&] { alignment = align_estimate(reference, estimate, options, inputs); });
    require_trust(*alignment, trust_rule(options));
    T_ref_est = alignment->T_dst_src;
  }
  std::optional<SensitivityBand> band;
  if (options.sensitivity) {
    timed("sensitivity", 0.15,
          [&] { band = sensitivity_band(reference, estimate, plain(options), T_ref_est, same_sink); });
  }
  std::vector<Eigen::Vector3d> sensor_positions = inputs.sensor_positions;
  for (Eigen::Vector3d& p : sensor_positions) p = (T_ref_est * p.homogeneous()).head<3>();
  EvaluatedPair evaluation =
      evaluate(std::move(reference), std::move(estimate), options, T_ref_est, same_sink, sensor_positions);
  evaluation.warnings.insert(evaluation.warnings.begin(), inputs.warnings.begin(), inputs.warnings.end());
  if (alignment) warn_of_alignment(*alignment, evaluation.warnings);
  evaluation.alignment = std::move(alignment);
  evaluation.metrics_before = std::move(before);
  if (band) {
    band->include(evaluation.metrics);
    evaluation.sensitivity = band->found(options);
  }
  evaluation.stage_seconds.insert(evaluation.stage_seconds.begin(), stages.begin(), stages.end());
  return evaluation;
}

}  // namespace cmap
