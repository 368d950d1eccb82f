#include "cmap/recon/placed_session.hpp"

namespace cmap {

std::vector<double> times_of(const SessionPredictions& session) {
  std::vector<double> times_s;
  for (const PredictionFrame& frame : session.frames) times_s.push_back(frame.time_s);
  return times_s;
}

std::vector<SessionFrame> frames_of(const SessionPredictions& session) {
  std::vector<SessionFrame> frames;
  for (std::size_t i = 0; i < session.frame_count(); ++i) {
    frames.push_back({session.frames[i].time_s, session.T_camera_session[i]});
  }
  return frames;
}

PlacedSession placed_session(std::size_t index, std::span<const SessionFrame> frames, const Similarity& T_world_session,
                             double rmse_m) {
  PlacedSession placed{index, T_world_session.scale, {}, {}, rmse_m};
  for (const SessionFrame& frame : frames) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = T_world_session.rotation * frame.T_camera_session.linear().transpose();
    pose.translation() = T_world_session * camera_center(frame);
    placed.time_s.push_back(frame.time_s);
    placed.T_world_camera.push_back(pose);
  }
  return placed;
}

}  // namespace cmap
