#pragma once

#include <string>
#include <vector>

#include "cmap/align/sim3_icp.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "cmap/geometry/similarity.hpp"
#include "cmap/recon/session_points.hpp"

namespace cmap {

/// What is done after pre-fusion (PIPELINE, "Registration").
enum class Registration {
  kPrefusion,  ///< nothing: its result is kept
  kNormal,     ///< Sim(3)-ICP without an expected scale, fixed gate, no crop
  kPaper,      ///< constant beta, fixed gate, no crop
  kRobust,     ///< annealed beta and gate, crop, confidence and Cauchy weights
};

/// "prefusion", "normal", "paper" or "robust". Throws UsageError for anything else.
Registration registration_from_name(std::string_view name);
std::string_view registration_name(Registration registration);

/// The registration of one session onto the LiDAR.
struct LidarRegistration {
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
/// session that fits no better afterwards (mean squared distance, those beyond three voxels counted as three): voxels
/// too coarse for the scene slide along it.
/// @param session  in the world, by pre-fusion, with confidences
/// @param sigma_m  RMSE of its camera centers in pre-fusion
LidarRegistration register_on_lidar(const SessionCloud& session, const PointCloud& lidar,
                                    const Similarity& T_world_session, Registration registration, double voxel_m,
                                    double sigma_m);

}  // namespace cmap
