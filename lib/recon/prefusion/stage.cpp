#include "prefusion/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/core/error.hpp"
#include "sessions/odometry.hpp"
#include "sessions/pose_convention.hpp"
#include "sessions/shared_frames.hpp"
#include "sessions/time_spans.hpp"
#include "sessions/usable_predictions.hpp"

namespace cmap {
namespace {

using ScaleRatios = std::vector<std::optional<ScaleRatio>>;  ///< between a session that is kept and the next

std::span<const float> plane(const Array<float>& values, std::size_t frame, std::size_t size) {
  return std::span<const float>(values).subspan(frame * size, size);
}

/// Scale of b over that of a from the frames of both.
std::optional<ScaleRatio> scale_ratio(const SessionPredictions& a, const SessionPredictions& b, double same_frame_s,
                                      const PreFusionOptions& options) {
  std::vector<SharedFrame> depths;
  std::vector<Eigen::Vector3d> centers_a, centers_b;
  const bool same_pixels = a.width == b.width && a.height == b.height;
  const std::size_t size = a.pixels_per_frame();
  for (const auto& [i, j] : shared_frames(times_of(a), times_of(b), same_frame_s)) {
    centers_a.push_back(a.T_camera_session[i].inverse().translation());
    centers_b.push_back(b.T_camera_session[j].inverse().translation());
    if (!same_pixels) continue;
    depths.push_back({plane(a.depth, i, size), plane(a.depth_confidence, i, size), plane(b.depth, j, size),
                      plane(b.depth_confidence, j, size)});
  }
  return options.overlap_scale == OverlapScale::kCenters ? scale_ratio_of_centers(centers_a, centers_b)
                                                         : scale_ratio_of_depths(depths, options.overlap_min_pixels);
}

/// A session's name, frames and confidence; or why it is dropped. The predictions stay for the overlap with the next.
struct ReadSession {
  SessionState state;
  std::vector<SessionFrame> frames;
  OdometryPoses T_world_camera;  ///< of the frames
  std::optional<SessionPredictions> predictions;
};

ReadSession read_and_check(const Capture& capture, std::size_t index, const SessionInputOptions& input) {
  ReadSession session;
  SessionOutcome& outcome = session.state.outcome;
  outcome.index = index;
  outcome.name = capture.sessions[index].filename().string();
  try {
    session.predictions = read_usable_predictions(capture, index, input.farthest_median_depths);
    outcome.frames = session.predictions->frame_count();
    for (const Warning& warning : session.predictions->warnings) outcome.flags.push_back(warning.message);
    session.frames = frames_of(*session.predictions);
    session.state.min_confidence = confidence_threshold(*session.predictions, input.confidence, input.points);
    const std::vector<double> times_s = times_of(*session.predictions);
    session.T_world_camera = odometry_poses(capture, times_s, input);
    const OdometryPoses& poses = session.T_world_camera;
    const auto n_placed = std::ranges::count_if(poses, [](const auto& pose) { return pose.has_value(); });
    if (n_placed == 0) throw UnsupportedError(no_common_time(times_s, capture.lio, input.max_gap_s));
    require_pose_convention(capture.sessions[index].string(), *session.predictions, poses, input.convention);
    if (n_placed < std::ssize(poses)) {
      outcome.flags.push_back(
          fmt::format("{} of {} frames have no LiDAR-inertial pose", std::ssize(poses) - n_placed, poses.size()));
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
bool reaches_inlier(const VotedScales& voted, const ScaleRatios& ratios, std::size_t k) {
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
  const double change = found.voted.scales[k] / found.placements[k].T_world_session.scale;
  return std::abs(std::log(change)) <= std::log(options.unlinked_tolerance);
}

/// What pre-fusion found for the k-th session that is kept.
void tell(const PreFusion& found, std::size_t k, const ScaleRatios& ratios, const PreFusionOptions& all_options,
          SessionState& state) {
  const SessionPlacementOptions& options = all_options.placement;
  const SessionPlacement& placement = found.placements[k];
  SessionOutcome& outcome = state.outcome;
  state.T_world_session = found.T_world_session[k];
  outcome.scale_prefusion = state.T_world_session.scale;
  outcome.linearity = placement.linearity;
  outcome.rotation_corrected =
      options.rotation == RotationCorrection::kJoint || placement.linearity > options.linearity_threshold;
  outcome.scale_inlier = is_inlier(found, k, all_options.voting);
  const bool has_neighbors = reaches_inlier(found.voted, ratios, k);
  if (placement.has_baseline && !outcome.scale_inlier && !has_neighbors) {
    outcome.flags.push_back(fmt::format("outvoted, and linked to no inlier: it keeps the scale {:.4g} of its path",
                                        outcome.scale_prefusion));
  } else if (placement.has_baseline && !outcome.scale_inlier) {
    // Its path fits the trajectory with its own scale, its depths fit the neighbors' with the one that was voted.
    state.center_factor = placement.T_world_session.scale / state.T_world_session.scale;
    state.T_world_session.translation = placement.T_world_session.translation;
    outcome.flags.push_back(fmt::format("scale {:.4g} of its path against {:.4g} of its neighbors",
                                        placement.T_world_session.scale, state.T_world_session.scale));
  }
  outcome.prefusion_rmse_m = placement.position_rmse_m;
  outcome.flags.insert(outcome.flags.end(), placement.warnings.begin(), placement.warnings.end());
  if (placement.has_baseline) return;
  outcome.flags.push_back(has_neighbors ? "no usable baseline: the scale is that of its neighbors"
                                        : "no usable baseline and no overlap with a session that has one: the scale is "
                                          "the median of the others', and may be far off");
}

/// The sessions that are kept, and what pre_fuse() takes of them.
struct KeptSessions {
  std::vector<std::size_t> places;  ///< in the list of all
  std::vector<std::vector<SessionFrame>> frames;
  std::vector<OdometryPoses> T_world_camera;
  ScaleRatios ratios;
};

void place(const KeptSessions& kept, const PreFusionOptions& options, std::vector<SessionState>& sessions) {
  const PreFusion found = pre_fuse(kept.frames, kept.T_world_camera, kept.ratios, options);
  for (std::size_t k = 0; k < kept.places.size(); ++k) {
    SessionState& state = sessions[kept.places[k]];
    tell(found, k, kept.ratios, options, state);
    std::vector<SessionFrame> frames = kept.frames[k];
    for (SessionFrame& frame : frames) frame.T_camera_session.translation() *= state.center_factor;
    state.placed = placed_session(state.outcome.index, frames, state.T_world_session, state.outcome.prefusion_rmse_m);
  }
}

}  // namespace

PreFusionOut run_pre_fusion(const PreFusionIn& in, const SessionInputOptions& input, const PreFusionOptions& options,
                            const std::function<void(double)>& progress) {
  PreFusionOut out;
  KeptSessions kept;
  std::optional<SessionPredictions> before;
  SeenTimes seen;
  const std::size_t n = in.capture.sessions.size();
  for (std::size_t index = 0; index < n; ++index) {
    if (in.only_session && *in.only_session != index) continue;
    if (progress) progress(static_cast<double>(index) / static_cast<double>(n));
    ReadSession session = read_and_check(in.capture, index, input);
    if (session.state.is_kept()) {
      const auto copy = seen.add(session.state.outcome.name, times_of(*session.predictions));
      if (copy) session.state.outcome.flags.push_back(*copy);
      if (!kept.places.empty()) {
        kept.ratios.push_back(before ? scale_ratio(*before, *session.predictions, input.same_frame_s, options)
                                     : std::nullopt);
      }
      kept.places.push_back(out.sessions.size());
      kept.frames.push_back(std::move(session.frames));
      kept.T_world_camera.push_back(std::move(session.T_world_camera));
    }
    before = std::move(session.predictions);
    out.sessions.push_back(std::move(session.state));
  }
  if (!kept.places.empty()) place(kept, options, out.sessions);
  return out;
}

}  // namespace cmap
