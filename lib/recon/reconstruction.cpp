#include "cmap/recon/reconstruction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <map>
#include <stdexcept>

#include "cmap/core/error.hpp"
#include "cmap/core/version.hpp"
#include "cmap/recon/fusion.hpp"
#include "session_state.hpp"
#include "stage_files.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> kStageNames{"prefusion", "registration", "posegraph", "fusion"};

/// What a later run must share to go on from this one's stages: the files by name, size and time of change, and the
/// options.
Json run_key(const Capture& capture, const ReconstructionOptions& options, const ReconstructionRun& run) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  const auto add = [&](const fs::directory_entry& entry) {
    if (!entry.is_regular_file()) return;
    files.push_back(fmt::format("{} {} {}", entry.path().lexically_relative(capture.folder).string(), entry.file_size(),
                                entry.last_write_time().time_since_epoch().count()));
  };
  // Only what is read: the results may lie in the capture's folder, too.
  for (const char* name : {"capture.json", "lidar.csv", "lio.tum"}) add(fs::directory_entry(capture.folder / name));
  for (const StampedFile& scan : capture.scans) add(fs::directory_entry(scan.path));
  for (const auto& entry : fs::directory_iterator(capture.folder / "predictions")) add(entry);
  for (const fs::path& session : capture.sessions) {
    if (!fs::is_directory(session)) continue;
    for (const auto& entry : fs::directory_iterator(session)) add(entry);
  }
  std::ranges::sort(files);
  return {{"version", kVersion},
          {"options", to_json(options)},
          {"only_session", run.only_session ? Json(*run.only_session) : Json(nullptr)},
          {"files", files}};
}

/// False where it is not as this program wrote it: then it is found again.
bool restored(const Json& found, std::vector<SessionState>& sessions, std::vector<SessionLink>& links) {
  std::vector<SessionState> read_sessions;
  std::vector<SessionLink> read_links;
  try {
    read_state(found, read_sessions, read_links);
  } catch (const Json::exception&) {
    return false;
  } catch (const std::invalid_argument&) {
    return false;
  }
  sessions = std::move(read_sessions);
  links = std::move(read_links);
  return true;
}

std::vector<PlacedSession> placed_of(const std::vector<SessionState>& sessions) {
  std::vector<PlacedSession> placed;
  for (const SessionState& session : sessions) {
    if (session.is_kept()) placed.push_back(session.placed);
  }
  return placed;
}

/// A map that silently misses half of the capture helps nobody.
void require_enough(const std::vector<SessionState>& sessions) {
  std::size_t n_all = 0, n_kept = 0;
  std::string first_reason;
  for (const SessionState& session : sessions) {
    ++n_all;
    if (session.is_kept()) ++n_kept;
    if (!session.is_kept() && first_reason.empty()) {
      first_reason = fmt::format("{}: {}", session.outcome.name, session.outcome.dropped);
    }
  }
  if (2 * n_kept >= n_all && n_kept > 0) return;
  throw UnsupportedError(
      fmt::format("{} of {} sessions had to be dropped; the first, {}", n_all - n_kept, n_all, first_reason));
}

void optimize_poses(const Capture& capture, const ReconstructionOptions& options, Reconstruction& result) {
  std::vector<OdometryPoses> odometry;
  for (const PlacedSession& session : result.poses) {
    odometry.push_back(odometry_poses(capture, session.time_s, options.prefusion));
  }
  const PoseGraph graph = session_graph(result.poses, result.links, odometry, {.lidar_priors = options.lidar_priors});
  const PoseGraphResult found = optimize(graph);
  result.graph_cost_before = found.initial_cost;
  result.graph_cost_after = found.final_cost;
  result.graph_iterations = found.iterations;
  for (std::size_t node = 0; node < graph.poses.size(); ++node) {
    const double moved_m = (found.poses[node].translation() - graph.poses[node].translation()).norm();
    result.largest_correction_m = std::max(result.largest_correction_m, moved_m);
  }
  if (!found.converged) result.warnings.push_back({"pose_graph_not_converged", "the pose graph had not settled"});
  for (const std::string& warning : found.warnings) result.warnings.push_back({"pose_graph", warning});
  result.poses = with_poses(result.poses, found.poses);
}

/// world_T_imu at every frame's time, from the session in which the frame is farthest from an end.
Trajectory trajectory_of(const std::vector<PlacedSession>& sessions, const CaptureCalibration& calibration) {
  const Eigen::Isometry3d T_camera_imu = (calibration.T_imu_lidar * calibration.T_lidar_camera).inverse();
  struct Choice {
    std::size_t from_end = 0;
    Eigen::Isometry3d T_world_camera;
  };
  std::map<double, Choice> choices;
  for (const PlacedSession& session : sessions) {
    const std::size_t n = session.time_s.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t from_end = std::min(i, n - 1 - i);
      const auto [place, is_new] = choices.try_emplace(session.time_s[i], Choice{from_end, session.T_world_camera[i]});
      if (!is_new && from_end > place->second.from_end) place->second = {from_end, session.T_world_camera[i]};
    }
  }
  Trajectory trajectory;
  for (const auto& [time_s, choice] : choices) {
    const Eigen::Isometry3d T_world_imu = choice.T_world_camera * T_camera_imu;
    trajectory.push_back({time_s, T_world_imu.translation(), Eigen::Quaterniond(T_world_imu.linear())});
  }
  return trajectory;
}

/// Evenly chosen pixels, about kSketchPoints of a session.
void add_sketch(const FramePoints& points, std::size_t frame, std::size_t n_frames, SessionSketch& sketch) {
  constexpr std::size_t kSketchPoints = 60'000;
  const std::size_t step = std::max<std::size_t>(1, points.positions.size() * n_frames / kSketchPoints);
  for (std::size_t i = step / 2; i < points.positions.size(); i += step) {
    sketch.positions.push_back(points.positions[i]);
    sketch.frame.push_back(static_cast<std::uint32_t>(frame));
  }
}

void fuse(const Capture& capture, const ReconstructionOptions& options, const ReconstructionRun& run,
          const std::vector<SessionState>& sessions, Reconstruction& result) {
  MapFusion fusion(options.fusion_voxel_m);
  std::size_t k = 0;
  for (const SessionState& state : sessions) {
    if (!state.is_kept()) continue;
    report_progress(stage_name(Stage::kFusion), static_cast<double>(k) / static_cast<double>(result.poses.size()));
    const PlacedSession& placed = result.poses[k++];
    const SessionPredictions session = read_corrected(capture, state);
    SessionSketch& sketch = result.sketches.emplace_back();
    const double max_range = options.fusion_max_range_m > 0.0 ? options.fusion_max_range_m / placed.scale
                                                              : std::numeric_limits<double>::infinity();
    std::optional<MapFusion> alone;
    if (run.session_map) alone.emplace(options.fusion_voxel_m);
    for (std::size_t i = 0; i < session.frame_count(); ++i) {
      const FramePoints points = frame_points(session, i, state.min_confidence, options.points, max_range);
      fusion.add(points, placed.T_world_camera[i], placed.scale);
      if (alone) alone->add(points, placed.T_world_camera[i], placed.scale);
      add_sketch(points, i, session.frame_count(), sketch);
    }
    if (alone && alone->size() > 0) run.session_map(state.outcome.name, alone->finish(options.fusion_doubt));
  }
  if (fusion.size() == 0) {
    throw UnsupportedError(fmt::format("no point is within fusion_max_range_m, {:g} m", options.fusion_max_range_m));
  }
  result.points_fused = fusion.points_added();
  result.map = fusion.finish(options.fusion_doubt);
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

Stage stage_from_name(std::string_view name) {
  for (std::size_t i = 0; i < kStageNames.size(); ++i) {
    if (kStageNames[i] == name) return static_cast<Stage>(i);
  }
  throw UsageError(fmt::format("stage \"{}\" is none of prefusion, registration, posegraph, fusion", name));
}

CaptureParts parts_needed(const ReconstructionOptions& options, Stage last) {
  CaptureParts parts{.images = Want::kNo, .scans = Want::kYes, .imu = Want::kNo};
  if (options.registration == Registration::kPrefusion) parts.scans = Want::kIfUsable;
  if (last < Stage::kRegistration) parts.scans = Want::kNo;
  return parts;
}

Reconstruction reconstruct(const Capture& capture, const ReconstructionOptions& options, const ReconstructionRun& run) {
  const ExecutionScope scope(run.execution);
  check_inputs(capture, options, run);
  const StageFiles stages(run.stages, run.resume, run_key(capture, options, run));
  std::vector<SessionState> sessions;
  Reconstruction result;
  result.warnings = capture.warnings;
  const auto timed = [&](Stage stage, auto&& work) {
    report_progress(stage_name(stage), 0.0);
    const auto start = std::chrono::steady_clock::now();
    work();
    result.stage_seconds.emplace_back(stage,
                                      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  };
  // Takes what an earlier run found, or finds it and keeps it.
  const auto staged = [&](Stage stage, auto&& work) {
    timed(stage, [&] {
      const auto found = stages.load(stage_name(stage));
      if (found && restored(*found, sessions, result.links)) return;
      work();
      stages.save(stage_name(stage), written(sessions, result.links));
    });
    result.poses = placed_of(sessions);
  };
  staged(Stage::kPrefusion, [&] { sessions = pre_fuse_sessions(capture, options, run.only_session); });
  require_enough(sessions);
  result.prefusion = result.poses;
  if (run.last >= Stage::kRegistration) {
    staged(Stage::kRegistration, [&] { result.links = register_sessions(capture, options, sessions); });
    result.registration = result.poses;
  }
  if (run.last >= Stage::kPoseGraph && options.pose_graph)
    timed(Stage::kPoseGraph, [&] { optimize_poses(capture, options, result); });
  result.trajectory = trajectory_of(result.poses, capture.calibration);
  if (run.last >= Stage::kFusion) timed(Stage::kFusion, [&] { fuse(capture, options, run, sessions, result); });
  for (const SessionState& session : sessions) {
    result.sessions.push_back(session.outcome);
    const SessionOutcome& outcome = session.outcome;
    if (!outcome.dropped.empty()) {
      result.warnings.push_back({"session_dropped", fmt::format("{}: dropped: {}", outcome.name, outcome.dropped)});
    }
    for (const std::string& flag : outcome.flags) {
      result.warnings.push_back({"session_flag", fmt::format("{}: {}", outcome.name, flag)});
    }
  }
  return result;
}

}  // namespace cmap
