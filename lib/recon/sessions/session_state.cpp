#include "sessions/session_state.hpp"

#include "sessions/usable_predictions.hpp"

namespace cmap {

std::vector<PlacedSession> placed_of(const std::vector<SessionState>& sessions) {
  std::vector<PlacedSession> placed;
  for (const SessionState& session : sessions) {
    if (session.is_kept()) placed.push_back(session.placed);
  }
  return placed;
}

SessionPredictions read_corrected(const Capture& capture, const SessionState& state, double farthest_median_depths) {
  SessionPredictions session = read_usable_predictions(capture, state.outcome.index, farthest_median_depths);
  if (state.center_factor == 1.0) return session;
  for (std::size_t frame = 0; frame < session.frame_count(); ++frame) {
    Eigen::Isometry3d& T_camera_session = session.T_camera_session[frame];
    const Eigen::Isometry3d before = T_camera_session;
    T_camera_session.translation() *= state.center_factor;  // so is the center, -R^T t
    if (session.world_points.empty()) continue;
    const Eigen::Isometry3f shift = (T_camera_session.inverse() * before).cast<float>();
    const std::size_t first = frame * session.pixels_per_frame();
    for (std::size_t i = 0; i < session.pixels_per_frame(); ++i) {
      session.world_points[first + i] = shift * session.world_points[first + i];
    }
  }
  return session;
}

}  // namespace cmap
