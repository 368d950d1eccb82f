#include "cmap/recon/reconstruction.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>

#include "cmap/core/error.hpp"
#include "fusion/stage.hpp"
#include "posegraph/stage.hpp"
#include "prefusion/stage.hpp"
#include "registration/stage.hpp"
#include "run_key.hpp"
#include "sessions/odometry.hpp"
#include "sessions/session_trajectory.hpp"
#include "stage_files.hpp"

namespace cmap {
namespace {

constexpr std::array<std::string_view, 4> kStageNames{"prefusion", "registration", "posegraph", "fusion"};

/// A map that silently misses half of the capture helps nobody.
void require_enough(const std::vector<SessionState>& sessions) {
  std::size_t n_all = 0, n_kept = 0;
  std::string first_reason;
  for (const SessionState& session : sessions) {
    ++n_all;
    if (session.is_kept()) ++n_kept;
    if (!session.is_kept() && first_reason.empty()) {
      first_reason = fmt::format("{}: {}", session.outcome.name, *session.outcome.dropped);
    }
  }
  if (2 * n_kept >= n_all && n_kept > 0) return;
  throw UnsupportedError(
      fmt::format("{} of {} sessions had to be dropped; the first, {}", n_all - n_kept, n_all, first_reason));
}

/// Runs stage after stage: times them, tells of them, and keeps in files what they found.
class StageRuns {
 public:
  StageRuns(const ReconstructionRun& run, nlohmann::ordered_json key)
      : files_(run.stages, run.resume, std::move(key)) {}

  /// `work` gets where to tell the share that is done.
  template <class Work>
  auto timed(Stage stage, const Work& work) {
    const auto tell = [&](double done) { report_progress(stage_name(stage), done); };
    tell(0.0);
    const auto start = std::chrono::steady_clock::now();
    auto out = work(tell);
    seconds_.emplace_back(stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return out;
  }
  /// The same, or what an earlier run has found.
  template <class Work>
  auto resumed(Stage stage, const Work& work) {
    return timed(stage, [&](const auto& tell) { return files_.found(stage_name(stage), [&] { return work(tell); }); });
  }
  const std::vector<std::pair<Stage, double>>& seconds() const { return seconds_; }

 private:
  StageFiles files_;
  std::vector<std::pair<Stage, double>> seconds_;
};

PoseGraphOut optimized(const Capture& capture, const ReconstructionOptions& options, const Reconstruction& result) {
  std::vector<OdometryPoses> odometry;
  for (const PlacedSession& session : result.poses) {
    odometry.push_back(odometry_poses(capture, session.time_s, options.input));
  }
  return run_pose_graph({result.poses, result.links, odometry}, options.graph);
}

void take(PoseGraphOut found, Reconstruction& result) {
  if (!found.converged) result.warnings.push_back({"pose_graph_not_converged", "the pose graph had not settled"});
  for (const std::string& warning : found.warnings) result.warnings.push_back({"pose_graph", warning});
  result.graph = found.summary;
  result.poses = std::move(found.sessions);
}

void take(FusionOut found, Reconstruction& result) {
  result.map = std::move(found.map);
  result.points_fused = found.points_fused;
  result.sketches = std::move(found.sketches);
}

/// What became of each session, and warnings of it.
void add_outcomes(const std::vector<SessionState>& sessions, Reconstruction& result) {
  for (const SessionState& session : sessions) {
    const SessionOutcome& outcome = session.outcome;
    result.sessions.push_back(outcome);
    if (outcome.dropped) {
      result.warnings.push_back({"session_dropped", fmt::format("{}: dropped: {}", outcome.name, *outcome.dropped)});
    }
    for (const std::string& flag : outcome.flags) {
      result.warnings.push_back({"session_flag", fmt::format("{}: {}", outcome.name, flag)});
    }
  }
}

void check_inputs(const Capture& capture, const ReconstructionOptions& options, const ReconstructionRun& run) {
  if (capture.sessions.empty()) {
    throw InputError(fmt::format("{}: no sessions of predictions", (capture.folder / "predictions").string()));
  }
  if (capture.lio.empty()) {
    throw InputError(
        fmt::format("{}: missing; LiDAR-inertial poses are needed", (capture.folder / "lio.tum").string()));
  }
  if (capture.scans.empty() && parts_needed(options, run.last).scans == Want::kYes) {
    throw InputError(fmt::format("{}: no scans; without them only --registration prefusion runs",
                                 (capture.folder / "lidar.csv").string()));
  }
  if (run.only_session && *run.only_session >= capture.sessions.size()) {
    throw UsageError(
        fmt::format("there is no session {}: the capture has {}", *run.only_session, capture.sessions.size()));
  }
}

}  // namespace

std::string_view stage_name(Stage stage) { return kStageNames.at(static_cast<std::size_t>(stage)); }

CaptureParts parts_needed(const ReconstructionOptions& options, Stage last) {
  // The IMU is read, if it can be, for what gravity says of the poses.
  CaptureParts parts{.images = Want::kNo, .scans = Want::kYes, .imu = Want::kIfUsable};
  if (options.registration.method == SessionRegistrationMethod::kPrefusion) parts.scans = Want::kIfUsable;
  if (last < Stage::kRegistration) parts.scans = Want::kNo;
  return parts;
}

Reconstruction reconstruct(const Capture& capture, const ReconstructionOptions& options, const ReconstructionRun& run) {
  const ExecutionScope scope(run.execution);
  check_inputs(capture, options, run);
  StageRuns stages(run, run_key(capture, options, run.only_session));
  Reconstruction result;
  result.warnings = capture.warnings;

  PreFusionOut prefused = stages.resumed(Stage::kPrefusion, [&](const auto& progress) {
    return run_pre_fusion({capture, run.only_session}, options.input, options.prefusion, progress);
  });
  std::vector<SessionState> sessions = std::move(prefused.sessions);
  require_enough(sessions);
  result.poses = result.prefusion = placed_of(sessions);

  if (run.last >= Stage::kRegistration) {
    RegistrationOut registered = stages.resumed(Stage::kRegistration, [&](const auto& progress) {
      return run_registration({capture, sessions}, options.input, options.registration, progress);
    });
    sessions = std::move(registered.sessions);
    result.links = std::move(registered.links);
    result.poses = result.registration = placed_of(sessions);
  }
  if (run.last >= Stage::kPoseGraph && options.pose_graph) {
    take(stages.resumed(Stage::kPoseGraph, [&](const auto&) { return optimized(capture, options, result); }), result);
  }
  result.trajectory = trajectory_of(result.poses, capture.calibration);
  if (run.last >= Stage::kFusion) {
    take(stages.timed(Stage::kFusion,
                      [&](const auto& progress) {
                        return run_fusion({capture, sessions, result.poses, run.session_map}, options.input,
                                          options.fusion, progress);
                      }),
         result);
  }
  result.stage_seconds = stages.seconds();
  add_outcomes(sessions, result);
  return result;
}

}  // namespace cmap
