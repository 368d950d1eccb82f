#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "cmap/core/error.hpp"
#include "session_state.hpp"

namespace cmap {
namespace {

/// What the LiDAR saw around a session. Pre-fusion alone is only measured by it, and goes on without.
LidarMap lidar_around(const Capture& capture, const ReconstructionOptions& options, const SessionPredictions& session,
                      SessionOutcome& outcome) {
  try {
    return lidar_map(capture, session.frames.front().time_s, session.frames.back().time_s, options.lidar,
                     options.prefusion.max_gap_s);
  } catch (const InputError& error) {
    if (options.registration != Registration::kPrefusion) throw;
    outcome.flags.push_back(fmt::format("not compared with the LiDAR: {}", error.what()));
    return {};
  }
}

/// Moves one session, placed by pre-fusion.
void register_one(const Capture& capture, const ReconstructionOptions& options, const SessionPredictions& session,
                  SessionState& state) {
  SessionOutcome& outcome = state.outcome;
  if (capture.scans.empty()) {
    outcome.overlap = outcome.rmse_m = std::numeric_limits<double>::quiet_NaN();
    return;  // of pre-fusion alone, which it stays
  }
  // Finer than the registration thins: its voxels then hold means of several.
  const SessionCloud cloud = session_cloud(session, state.T_world_session, state.min_confidence, options.points,
                                           options.registration_voxel_m / 2.0);
  const LidarMap lidar = lidar_around(capture, options, session, outcome);
  const LidarRegistration found = register_on_lidar(cloud, lidar.cloud, state.T_world_session, options.registration,
                                                    options.registration_voxel_m, outcome.prefusion_rmse_m);
  outcome.scale_registration = found.scale_change;
  outcome.overlap = found.overlap;
  outcome.rmse_m = found.rmse_m;
  outcome.flags.insert(outcome.flags.end(), found.flags.begin(), found.flags.end());
  state.T_world_session = found.T_world_session;
  const double rmse_m = found.accepted ? found.rmse_m : std::max(found.rmse_m, outcome.prefusion_rmse_m);
  state.placed = placed_session(outcome.index, frames_of(session), state.T_world_session, rmse_m);
}

}  // namespace

std::vector<SessionLink> register_sessions(const Capture& capture, const ReconstructionOptions& options,
                                           std::vector<SessionState>& sessions) {
  std::vector<SessionLink> links;
  std::optional<SessionPredictions> before;
  const SessionState* state_before = nullptr;
  std::size_t n_kept = 0;
  for (SessionState& state : sessions) {
    if (!state.is_kept()) continue;
    report_progress(stage_name(Stage::kRegistration),
                    static_cast<double>(n_kept) / static_cast<double>(sessions.size()));
    SessionPredictions session = read_corrected(capture, state);
    register_one(capture, options, session, state);
    if (before) {
      std::string reason;
      std::optional<SessionLink> link =
          link_sessions(*before, state_before->placed, state_before->min_confidence, session, state.placed,
                        state.min_confidence, {options.registration_voxel_m, options.points}, reason);
      if (link) {
        link->from = n_kept - 1;
        link->to = n_kept;
        links.push_back(*link);
      } else {
        state.outcome.flags.push_back(fmt::format("not linked to {}: {}", state_before->outcome.name, reason));
      }
    }
    before = std::move(session);
    state_before = &state;
    ++n_kept;
  }
  return links;
}

}  // namespace cmap
