#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "cmap/recon/reconstruction.hpp"

namespace cmap {

/// A session on its way through the stages.
struct SessionState {
  SessionOutcome outcome;
  Similarity T_world_session;
  double min_confidence = 0.0;  ///< pixels with less are no points
  /// What the session's camera centers are multiplied by: 1, but for outliers of scale, whose depths have the scale
  /// that was voted for them and whose path has its own.
  double center_factor = 1.0;
  PlacedSession placed;

  bool is_kept() const { return outcome.dropped.empty(); }
};

/// All of it, to go on from in a later run; numbers read back as they are.
nlohmann::ordered_json written(const std::vector<SessionState>& sessions, const std::vector<SessionLink>& links);
void read_state(const nlohmann::ordered_json& json, std::vector<SessionState>& sessions,
                std::vector<SessionLink>& links);

/// As sessions.json has it.
nlohmann::ordered_json written(const SessionOutcome& outcome);

/// How the capture's camera sits on the body.
CameraMount mount_of(const Capture& capture);

/// Where LiDAR-inertial odometry has the camera at these times.
OdometryPoses odometry_poses(const Capture& capture, std::span<const double> times_s, const PreFusionOptions& options);

/// A session as the stages after pre-fusion see it, its camera centers corrected.
SessionPredictions read_corrected(const Capture& capture, const SessionState& state);

/// Reads the sessions (one, or all), says what their poses and overlaps say of their scales, and places them.
std::vector<SessionState> pre_fuse_sessions(const Capture& capture, const ReconstructionOptions& options,
                                            std::optional<std::size_t> only_session);

/// Moves each session onto the LiDAR, and links those that follow each other.
std::vector<SessionLink> register_sessions(const Capture& capture, const ReconstructionOptions& options,
                                           std::vector<SessionState>& sessions);

}  // namespace cmap
