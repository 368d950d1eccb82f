#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

#include "cmap/geometry/session_predictions.hpp"
#include "cmap/geometry/similarity.hpp"

namespace cmap {

/// One frame of a session as VGGT predicts it.
struct SessionFrame {
  double time_s = 0.0;
  Eigen::Isometry3d T_camera_session = Eigen::Isometry3d::Identity();  ///< camera from session, in the session's unit
};

/// The camera's center in the session, -R^T t.
inline Eigen::Vector3d camera_center(const SessionFrame& frame) {
  return -(frame.T_camera_session.linear().transpose() * frame.T_camera_session.translation());
}

std::vector<double> times_of(const SessionPredictions& session);

/// A session's frames without their pictures.
std::vector<SessionFrame> frames_of(const SessionPredictions& session);

/// A session in the world: where its cameras are, and the meters in its unit.
struct PlacedSession {
  std::size_t index = 0;  ///< of the capture's sessions
  double scale = 1.0;
  std::vector<double> time_s;                     ///< of the frames
  std::vector<Eigen::Isometry3d> T_world_camera;  ///< of the frames
  double rmse_m = 0.0;                            ///< of the stage that has put it there
};

/// A session's cameras where a similarity puts them.
PlacedSession placed_session(std::size_t index, std::span<const SessionFrame> frames, const Similarity& T_world_session,
                             double rmse_m);

}  // namespace cmap
