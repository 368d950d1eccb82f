#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cmap/geometry/similarity.hpp"
#include "cmap/recon/placed_session.hpp"

namespace cmap {

enum class RotationCorrection {
  kJoint,  ///< the Wahba problem of camera centers and camera rotations together
  kPaper,  ///< Umeyama's rotation, replaced by the mean of the camera rotations where the path is straight
};

struct SessionPlacementOptions {
  RotationCorrection rotation = RotationCorrection::kJoint;
  double linearity_threshold = 0.99;     ///< kPaper: straighter paths take the mean of the camera rotations
  double min_spread_m = 0.05;            ///< standard deviation along the path below which there is no baseline
  double sigma_position_m = 0.3;         ///< kJoint: of a camera center, VGGT's against the trajectory's
  double sigma_rotation_deg = 0.5;       ///< kJoint: of a camera rotation, likewise
  double sigma_extrinsic_deg = 1.5;      ///< kJoint: of the calibration between camera and LiDAR, common to all frames
  double cauchy_deg = 5.0;               ///< camera rotations farther from the mean count less,
  int cauchy_passes = 3;                 ///< weighed this often
  double least_sigma_log_scale = 0.005;  ///< no scale is known better, whatever the residuals say: VGGT bends its paths
};

/// Throws UsageError naming the field, its value and the rule it breaks.
void check_options(const SessionPlacementOptions& options);

/// A session laid on the world: x_world = s1 R1 x_session + t1.
struct SessionPlacement {
  Similarity T_world_session;
  bool has_baseline = false;          ///< false: the scale is unusable, and 1 in T_world_session
  double sigma_log_scale = 0.0;       ///< standard deviation of log s1; infinite without baseline
  double linearity = 0.0;             ///< of the metric camera centers, 1 - (l2 + l3) / l1; 0 without baseline
  double session_linearity = 0.0;     ///< of VGGT's
  std::optional<Similarity> umeyama;  ///< the fit to the centers alone; none where it leaves the rotation free
  double correction_deg = 0.0;        ///< from Umeyama's rotation to R1
  double position_rmse_m = 0.0;
  double rotation_rmse_deg = 0.0;
  std::size_t n_pairs = 0;                                 ///< frames with a camera pose in the world
  Eigen::Vector3d mean_session = Eigen::Vector3d::Zero();  ///< of the paired centers
  Eigen::Vector3d mean_world = Eigen::Vector3d::Zero();
  std::vector<std::string> warnings;
};

/// Fit of the camera centers, linearity check and rotation correction of one session. `T_world_camera`: of each frame,
/// as camera_poses() gives them; frames without one do not count. Rotations are camera-to-world on both sides:
///   kPaper, straight: R1 = proj(sum w_i R_i^world (R_i^session)^T), which does not depend on Umeyama's rotation, with
///   Cauchy weights;
///   kJoint: R1 = proj(s sum y~ x~^T / sigma_t^2 + sum w_i R_i^world (R_i^session)^T / (2 (sigma_R^2 + L
///   sigma_ext^2))),
/// then s1 = sum y~ . R1 x~ / sum |x~|^2 and t1 = y_mean - s1 R1 x_mean (x VGGT's centers, y metric ones).
/// Thread-safe. Throws UnsupportedError where no frame has a pose in the world, UsageError for options,
/// std::invalid_argument where the lists differ in length.
SessionPlacement place_session(std::span<const SessionFrame> frames,
                               std::span<const std::optional<Eigen::Isometry3d>> T_world_camera,
                               const SessionPlacementOptions& options = {});

/// The same placement with another scale: rotation kept, t1 = y_mean - s R1 x_mean.
Similarity with_scale(const SessionPlacement& placement, double scale);

}  // namespace cmap
