#pragma once

#include "cmap/recon/camera_poses.hpp"
#include "cmap/recon/scale_voting.hpp"
#include "cmap/recon/session_placement.hpp"

namespace cmap {

struct PreFusionOptions {
  SessionPlacementOptions placement;
  OverlapScale overlap_scale = OverlapScale::kDepths;
  int overlap_min_pixels = 100;  ///< good in both sessions, of kDepths
  ScaleVotingOptions voting;

  /// As printed in the paper, which also takes the nearest camera poses.
  static PreFusionOptions paper();
};

/// Every session on the world, with scales that agree.
struct PreFusion {
  std::vector<SessionPlacement> placements;  ///< each by itself
  VotedScales voted;
  std::vector<Similarity> T_world_session;  ///< the result: placements with the voted scales
};

/// The pre-fusion of the pipeline: placement by camera poses (one list for each session, as camera_poses() gives them),
/// linearity, rotation correction, scale voting and correction. `ratios` as in vote_scales(). Thread-safe. Throws as
/// its parts; UnsupportedError names the session.
PreFusion pre_fuse(std::span<const std::vector<SessionFrame>> sessions, std::span<const OdometryPoses> T_world_camera,
                   std::span<const std::optional<ScaleRatio>> ratios, const PreFusionOptions& options = {});

}  // namespace cmap
