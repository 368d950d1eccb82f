#pragma once

#include <string>
#include <vector>

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/geometry/similarity.hpp"
#include "cmap/lio/lidar_map.hpp"
#include "cmap/recon/session_link.hpp"
#include "cmap/recon/session_points.hpp"

namespace cmap {

/// How sessions are moved onto the LiDAR (PIPELINE, "Registration").
enum class SessionRegistrationMethod {
  kPrefusion,  ///< not at all: the result of pre-fusion is kept
  kNormal,     ///< Sim(3)-ICP without an expected scale, fixed gate, no crop
  kPaper,      ///< constant beta, fixed gate, no crop
  kRobust,     ///< annealed beta and gate, crop, confidence and Cauchy weights
};

/// Gates are in voxels. Of kNormal and kPaper gate and beta stay as they are at first (beta 0 of kNormal).
struct RegistrationOptions {
  SessionRegistrationMethod method = SessionRegistrationMethod::kRobust;
  double voxel_m = 0.2;            ///< what the session is thinned to; the LiDAR's points to half of it
  double thinning = 0.5;           ///< before, each frame's points are thinned to this share of it
  double first_gate = 10.0;        ///< farther pairs are no matches
  double first_gate_sigmas = 3.0;  ///< kRobust: or this many RMSE of pre-fusion, where that is more
  double last_gate = 3.0;          ///< kRobust: at the end
  double crop_cell = 5.0;          ///< kRobust: side of the cells that say where the LiDAR saw something, in voxels
  double first_beta = 0.1;         ///< strength of the expected scale
  double last_beta = 1e-4;         ///< kRobust: at the end
  int iterations = 60;             ///< at most
  int annealed_iterations = 36;    ///< kRobust: of these
  double kernel_width = 0.5;       ///< kRobust: of the Cauchy weights, as a share of the gate
  int neighbors = 10;              ///< for the normals that tell which direction is free
  int min_matches = 100;           ///< fewer keep the result of pre-fusion;
  double min_overlap = 0.1;        ///< so does a smaller share of the session's points
  double match_gate = 3.0;         ///< of what is reported: overlap and RMSE
  LidarMapOptions lidar;
  bool lidar_in_view = false;  ///< of the scans only what the session's cameras look at
  LinkOptions link;
};

/// The registration of one session onto the LiDAR.
struct SessionRegistration {
  Similarity T_world_session;  ///< the session as it is afterwards
  double scale_change = 1.0;   ///< s2: of the registration alone
  double overlap = 0.0;        ///< share of the session's points that match
  double rmse_m = 0.0;         ///< of the matches
  std::size_t n_matches = 0;
  int iterations = 0;
  bool accepted = true;            ///< false: the pre-fusion result is kept
  std::vector<std::string> flags;  ///< why it is doubtful, for people
};

/// Moves a session onto the LiDAR's points from where pre-fusion has put it (regularized cross-modal Sim(3), expected
/// scale change 1). Nothing throws for lack of overlap: the session stays and is flagged. So does, with kRobust, a
/// session that fits no better afterwards (mean squared distance, those beyond match_gate counted as at it): voxels too
/// coarse for the scene slide along it.
/// @param session  in the world, by pre-fusion, with confidences
/// @param sigma_m  RMSE of its camera centers in pre-fusion
SessionRegistration register_session(const SessionCloud& session, const PointCloud& lidar,
                                     const Similarity& T_world_session, const RegistrationOptions& options,
                                     double sigma_m);

}  // namespace cmap
