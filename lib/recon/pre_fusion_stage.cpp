#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/recon/overlap_scale.hpp"
#include "pose_convention.hpp"
#include "session_state.hpp"
#include "shared_frames.hpp"
#include "time_spans.hpp"
#include "usable_predictions.hpp"

namespace cmap {
namespace {

std::span<const float> plane(const Array<float>& values, std::size_t frame, std::size_t size) {
  return std::span<const float>(values).subspan(frame * size, size);
}

/// Scale of b over that of a from the frames of both.
std::optional<ScaleRatio> scale_ratio(const SessionPredictions& a, const SessionPredictions& b, OverlapScale by) {
  std::vector<SharedFrame> depths;
  std::vector<Eigen::Vector3d> centers_a, centers_b;
  const bool same_pixels = a.width == b.width && a.height == b.height;
  const std::size_t size = a.pixels_per_frame();
  for (const auto& [i, j] : shared_frames(times_of(a), times_of(b))) {
    centers_a.push_back(a.T_camera_session[i].inverse().translation());
    centers_b.push_back(b.T_camera_session[j].inverse().translation());
    if (!same_pixels) continue;
    depths.push_back({plane(a.depth, i, size), plane(a.depth_confidence, i, size), plane(b.depth, j, size),
                      plane(b.depth_confidence, j, size)});
  }
  return by == OverlapScale::kCenters ? scale_ratio_of_centers(centers_a, centers_b) : scale_ratio_of_depths(depths);
}

/// A session's name, frames and confidence; or why it is dropped. The predictions stay for the overlap with the next.
struct ReadSession {
  SessionState state;
  std::vector<SessionFrame> frames;
  std::optional<SessionPredictions> predictions;
};

ReadSession read_and_place(const Capture& capture, std::size_t index, const ReconstructionOptions& options) {
  ReadSession session;
  SessionOutcome& outcome = session.state.outcome;
  outcome.index = index;
  outcome.name = capture.sessions[index].filename().string();
  try {
    session.predictions = read_usable_predictions(capture, index);
    outcome.frames = session.predictions->frame_count();
    for (const Warning& warning : session.predictions->warnings) outcome.flags.push_back(warning.message);
    session.frames = frames_of(*session.predictions);
    session.state.min_confidence = confidence_threshold(*session.predictions, options.confidence, options.points);
    const std::vector<double> times_s = times_of(*session.predictions);
    const OdometryPoses poses = odometry_poses(capture, times_s, options.prefusion);
    const auto n_placed = std::ranges::count_if(poses, [](const auto& pose) { return pose.has_value(); });
    if (n_placed == 0) throw UnsupportedError(no_common_time(times_s, capture.lio, options.prefusion.max_gap_s));
    require_pose_convention(capture.sessions[index].string(), *session.predictions, poses);
    if (n_placed < static_cast<std::ptrdiff_t>(poses.size())) {
      outcome.flags.push_back(fmt::format("{} of {} frames have no LiDAR-inertial pose",
                                          static_cast<std::ptrdiff_t>(poses.size()) - n_placed, poses.size()));
    }
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    outcome.dropped = error.what();
    session.predictions.reset();
  }
  return session;
}

/// Whether ratios lead from the k-th session to an inlier of the vote, which then says its scale.
bool reaches_inlier(const VotedScales& voted, const std::vector<std::optional<ScaleRatio>>& ratios, std::size_t k) {
  std::size_t first = k, last = k;
  while (first > 0 && ratios[first - 1]) --first;
  while (last < ratios.size() && ratios[last]) ++last;
  return std::any_of(voted.is_inlier.begin() + static_cast<std::ptrdiff_t>(first),
                     voted.is_inlier.begin() + static_cast<std::ptrdiff_t>(last) + 1, [](char c) { return c != 0; });
}

/// Where half of the sessions are off, the vote's tolerance, a multiple of the MAD, takes all for inliers; what the
/// neighbors then made of the scale tells.
bool is_inlier(const PreFusion& found, std::size_t k, const ScaleVotingOptions& options) {
  if (found.voted.is_inlier[k] == 0) return false;
  const double change = found.voted.scales[k] / found.registrations[k].T_world_session.scale;
  return std::abs(std::log(change)) <= std::log(options.unlinked_tolerance);
}

/// What pre-fusion found for the k-th session that is kept.
void tell(const PreFusion& found, std::size_t k, const std::vector<std::optional<ScaleRatio>>& ratios,
          const PreFusionOptions& all_options, SessionState& state) {
  const SessionRegistrationOptions& options = all_options.registration;
  const SessionRegistration& registration = found.registrations[k];
  SessionOutcome& outcome = state.outcome;
  state.T_world_session = found.T_world_session[k];
  outcome.scale_prefusion = state.T_world_session.scale;
  outcome.linearity = registration.linearity;
  outcome.rotation_corrected =
      options.rotation == RotationCorrection::kJoint || registration.linearity > options.linearity_threshold;
  outcome.scale_inlier = is_inlier(found, k, all_options.voting);
  const bool has_neighbors = reaches_inlier(found.voted, ratios, k);
  if (registration.has_baseline && !outcome.scale_inlier && !has_neighbors) {
    outcome.flags.push_back(fmt::format("outvoted, and linked to no inlier: it keeps the scale {:.4g} of its path",
                                        outcome.scale_prefusion));
  } else if (registration.has_baseline && !outcome.scale_inlier) {
    // Its path fits the trajectory with its own scale, its depths fit the neighbors' with the one that was voted.
    state.center_factor = registration.T_world_session.scale / state.T_world_session.scale;
    state.T_world_session.translation = registration.T_world_session.translation;
    outcome.flags.push_back(fmt::format("scale {:.4g} of its path against {:.4g} of its neighbors",
                                        registration.T_world_session.scale, state.T_world_session.scale));
  }
  outcome.prefusion_rmse_m = registration.position_rmse_m;
  outcome.flags.insert(outcome.flags.end(), registration.warnings.begin(), registration.warnings.end());
  if (registration.has_baseline) return;
  outcome.flags.push_back(has_neighbors ? "no usable baseline: the scale is that of its neighbors"
                                        : "no usable baseline and no overlap with a session that has one: the scale is "
                                          "the median of the others', and may be far off");
}

}  // namespace

std::vector<SessionState> pre_fuse_sessions(const Capture& capture, const ReconstructionOptions& options,
                                            std::optional<std::size_t> only_session) {
  std::vector<SessionState> sessions;
  std::vector<std::vector<SessionFrame>> frames;  // of those that are kept
  std::vector<std::optional<ScaleRatio>> ratios;  // between one of these and the next
  std::vector<std::size_t> kept;
  std::optional<SessionPredictions> before;
  SeenTimes seen;
  for (std::size_t index = 0; index < capture.sessions.size(); ++index) {
    if (only_session && *only_session != index) continue;
    report_progress(stage_name(Stage::kPrefusion),
                    static_cast<double>(index) / static_cast<double>(capture.sessions.size()));
    ReadSession session = read_and_place(capture, index, options);
    if (session.state.is_kept()) {
      const std::string copy = seen.add(session.state.outcome.name, times_of(*session.predictions));
      if (!copy.empty()) session.state.outcome.flags.push_back(copy);
      if (!kept.empty()) {
        ratios.push_back(before ? scale_ratio(*before, *session.predictions, options.overlap_scale) : std::nullopt);
      }
      kept.push_back(sessions.size());
      frames.push_back(std::move(session.frames));
    }
    before = std::move(session.predictions);
    sessions.push_back(std::move(session.state));
  }
  if (kept.empty()) return sessions;
  const PreFusion found = pre_fuse(frames, capture.lio, mount_of(capture), ratios, options.prefusion);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    SessionState& state = sessions[kept[k]];
    tell(found, k, ratios, options.prefusion, state);
    for (SessionFrame& frame : frames[k]) frame.T_camera_session.translation() *= state.center_factor;
    state.placed =
        placed_session(state.outcome.index, frames[k], state.T_world_session, state.outcome.prefusion_rmse_m);
  }
  return sessions;
}

}  // namespace cmap
