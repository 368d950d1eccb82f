#pragma once

#include "cmap/recon/camera_poses.hpp"
#include "cmap/recon/scale_voting.hpp"
#include "cmap/recon/session_registration.hpp"

namespace cmap {

struct PreFusionOptions {
  PosePairing pairing = PosePairing::kInterpolated;
  double max_gap_s = 0.15;
  SessionRegistrationOptions registration;
  ScaleVotingOptions voting;

  /// As printed in the paper; its scale ratios are those of scale_ratio_of_centers().
  static PreFusionOptions paper();
};

/// Every session on the world, with scales that agree.
struct PreFusion {
  std::vector<SessionRegistration> registrations;  ///< each by itself
  VotedScales voted;
  std::vector<Similarity> T_world_session;  ///< the result: registrations with the voted scales
};

/// The pre-fusion of the pipeline: camera poses, registration, linearity, rotation correction, scale voting and
/// correction. `ratios` as in vote_scales(). Thread-safe. Throws as its parts; UnsupportedError names the session.
PreFusion pre_fuse(std::span<const std::vector<SessionFrame>> sessions, const Trajectory& world_T_imu,
                   const CameraMount& mount, std::span<const std::optional<ScaleRatio>> ratios,
                   const PreFusionOptions& options = {});

}  // namespace cmap
