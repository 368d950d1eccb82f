#include "registration/stage.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>

#include "cmap/core/error.hpp"
#include "registration/in_view.hpp"

namespace cmap {
namespace {

/// What the LiDAR saw around a session. Pre-fusion alone is only measured by it, and goes on without.
LidarMap lidar_around(const Capture& capture, const SessionPredictions& session, const SessionInputOptions& input,
                      const RegistrationOptions& options, SessionOutcome& outcome) {
  try {
    return lidar_map(capture, session.frames.front().time_s, session.frames.back().time_s, options.lidar,
                     input.max_gap_s);
  } catch (const InputError& error) {
    if (options.method != SessionRegistrationMethod::kPrefusion) throw;
    outcome.flags.push_back(fmt::format("not compared with the LiDAR: {}", error.what()));
    return {};
  }
}

/// Moves one session, placed by pre-fusion.
void register_one(const Capture& capture, const SessionPredictions& session, const SessionInputOptions& input,
                  const RegistrationOptions& options, SessionState& state) {
  SessionOutcome& outcome = state.outcome;
  if (capture.scans.empty()) {
    outcome.overlap = outcome.rmse_m = std::numeric_limits<double>::quiet_NaN();
    return;  // of pre-fusion alone, which it stays
  }
  // Finer than the registration thins: its voxels then hold means of several.
  const SessionCloud cloud = session_cloud(session, state.T_world_session, state.min_confidence, input.points,
                                           options.thinning * options.voxel_m);
  LidarMap lidar = lidar_around(capture, session, input, options, outcome);
  if (options.lidar_in_view) lidar.cloud = in_view(lidar.cloud, session, state.T_world_session);
  const SessionRegistration found =
      register_session(cloud, lidar.cloud, state.T_world_session, options, outcome.prefusion_rmse_m);
  outcome.scale_registration = found.scale_change;
  outcome.overlap = found.overlap;
  outcome.rmse_m = found.rmse_m;
  outcome.flags.insert(outcome.flags.end(), found.flags.begin(), found.flags.end());
  state.T_world_session = found.T_world_session;
  const double rmse_m = found.accepted ? found.rmse_m : std::max(found.rmse_m, outcome.prefusion_rmse_m);
  state.placed = placed_session(outcome.index, frames_of(session), state.T_world_session, rmse_m);
}

LinkedSession linked(const SessionPredictions& session, const SessionState& state) {
  return {session, state.placed, state.min_confidence};
}

}  // namespace

RegistrationOut run_registration(const RegistrationIn& in, const SessionInputOptions& input,
                                 const RegistrationOptions& options, const std::function<void(double)>& progress) {
  RegistrationOut out{in.sessions, {}};
  std::optional<SessionPredictions> before;
  const SessionState* state_before = nullptr;
  std::size_t n_kept = 0;
  for (SessionState& state : out.sessions) {
    if (!state.is_kept()) continue;
    if (progress) progress(static_cast<double>(n_kept) / static_cast<double>(out.sessions.size()));
    SessionPredictions session = read_corrected(in.capture, state, input.farthest_median_depths);
    register_one(in.capture, session, input, options, state);
    if (before) {
      auto found = link_sessions(linked(*before, *state_before), linked(session, state), input.points,
                                 input.same_frame_s, options.voxel_m, options.link);
      if (auto* link = std::get_if<SessionLink>(&found)) {
        link->from = n_kept - 1;
        link->to = n_kept;
        out.links.push_back(*link);
      } else {
        state.outcome.flags.push_back(
            fmt::format("not linked to {}: {}", state_before->outcome.name, std::get<NotLinked>(found).reason));
      }
    }
    before = std::move(session);
    state_before = &state;
    ++n_kept;
  }
  return out;
}

}  // namespace cmap
