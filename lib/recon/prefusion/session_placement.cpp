#include "cmap/recon/session_placement.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "cmap/align/robust_kernel.hpp"
#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "degrees.hpp"

namespace cmap {
namespace {

/// Camera centers and camera-to-world rotations of the paired frames, session and world.
struct PairedFrames {
  std::vector<Eigen::Vector3d> x, y;
  std::vector<Eigen::Matrix3d> turns;  ///< R_i^world (R_i^session)^T: what R1 is, if frame i is right
  Eigen::Vector3d x_mean = Eigen::Vector3d::Zero(), y_mean = Eigen::Vector3d::Zero();

  std::size_t size() const { return x.size(); }
  double share() const { return 1.0 / static_cast<double>(size()); }
};

PairedFrames paired(std::span<const SessionFrame> frames,
                    std::span<const std::optional<Eigen::Isometry3d>> T_world_camera) {
  if (frames.size() != T_world_camera.size()) {
    throw std::invalid_argument("place_session: frames and camera poses must be equally many");
  }
  PairedFrames pairs;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!T_world_camera[i]) continue;
    pairs.x.push_back(camera_center(frames[i]));
    pairs.y.push_back(T_world_camera[i]->translation());
    // R_session = R_camera_session^T, so its transpose is the matrix itself.
    pairs.turns.push_back(T_world_camera[i]->linear() * frames[i].T_camera_session.linear());
    pairs.x_mean += pairs.x.back();
    pairs.y_mean += pairs.y.back();
  }
  if (pairs.size() == 0) throw UnsupportedError("no frame of the session has a camera pose in the world");
  pairs.x_mean *= pairs.share();
  pairs.y_mean *= pairs.share();
  return pairs;
}

/// Variances along the principal axes, rising.
Eigen::Vector3d principal_variances(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& mean) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) covariance += (p - mean) * (p - mean).transpose();
  covariance /= static_cast<double>(points.size());
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues().cwiseMax(0.0);
}

double linearity_of(const Eigen::Vector3d& variances) {
  return variances[2] > 0.0 ? 1.0 - (variances[0] + variances[1]) / variances[2] : 0.0;
}

/// sum w_i turn_i with Cauchy weights about its own rotation.
Eigen::Matrix3d robust_sum(const PairedFrames& pairs, const SessionPlacementOptions& options) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& turn : pairs.turns) sum += turn;
  for (int pass = 0; pass < options.cauchy_passes; ++pass) {
    const Eigen::Matrix3d mean = nearest_rotation(sum);
    sum.setZero();
    for (const Eigen::Matrix3d& turn : pairs.turns) {
      const double off_rad = rotation_angle_rad(mean.transpose() * turn);
      sum += robust_weight(RobustKernel::kCauchy, off_rad, options.cauchy_deg * kDegree_rad) * turn;
    }
  }
  return sum;
}

/// sum y~ x~^T
Eigen::Matrix3d centered_cross(const PairedFrames& pairs) {
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < pairs.size(); ++i)
    cross += (pairs.y[i] - pairs.y_mean) * (pairs.x[i] - pairs.x_mean).transpose();
  return cross;
}

double sum_sq_x(const PairedFrames& pairs) {
  double sum = 0.0;
  for (const Eigen::Vector3d& x : pairs.x) sum += (x - pairs.x_mean).squaredNorm();
  return sum;
}

/// sum y~ . R x~ / sum |x~|^2
double scale_for(const Eigen::Matrix3d& R, const Eigen::Matrix3d& cross, double sq_x) {
  return (R.transpose() * cross).trace() / sq_x;
}

/// The scale enters the weight of the centers and depends on the rotation: a few rounds settle both.
Eigen::Matrix3d joint_rotation(const PairedFrames& pairs, const SessionPlacementOptions& options) {
  const Eigen::Matrix3d turns = robust_sum(pairs, options);
  const Eigen::Matrix3d cross = centered_cross(pairs);
  const double sq_x = sum_sq_x(pairs);
  const double sigma_R = options.sigma_rotation_deg * kDegree_rad,
               sigma_ext = options.sigma_extrinsic_deg * kDegree_rad;
  const double sq_sigma = sigma_R * sigma_R + static_cast<double>(pairs.size()) * sigma_ext * sigma_ext;
  const double sq_sigma_t = options.sigma_position_m * options.sigma_position_m;
  Eigen::Matrix3d R = nearest_rotation(turns);
  constexpr int kMaxRounds = 100;
  for (int round = 0; round < kMaxRounds; ++round) {
    const double s = std::max(0.0, scale_for(R, cross, sq_x));
    const Eigen::Matrix3d next = nearest_rotation(s * cross / sq_sigma_t + turns / (2.0 * sq_sigma));
    const double step_rad = rotation_angle_rad(R.transpose() * next);
    R = next;
    if (step_rad < 1e-12) break;
  }
  return R;
}

std::optional<Similarity> umeyama_if_determined(const PairedFrames& pairs, std::vector<std::string>& warnings) {
  try {
    return umeyama(pairs.x, pairs.y);
  } catch (const UnsupportedError& error) {
    warnings.push_back(std::string("Umeyama on the camera centers: ") + error.what());
    return std::nullopt;
  }
}

Eigen::Matrix3d chosen_rotation(const PairedFrames& pairs, const SessionPlacement& result,
                                const SessionPlacementOptions& options) {
  if (!result.has_baseline) return nearest_rotation(robust_sum(pairs, options));
  if (options.rotation == RotationCorrection::kJoint) return joint_rotation(pairs, options);
  const bool straight = result.linearity > options.linearity_threshold || !result.umeyama;
  return straight ? nearest_rotation(robust_sum(pairs, options)) : result.umeyama->rotation;
}

void find_scale(const PairedFrames& pairs, const SessionPlacementOptions& options, SessionPlacement& result) {
  const double sq_x = sum_sq_x(pairs);
  const Eigen::Matrix3d& R = result.T_world_session.rotation;
  const double s = result.has_baseline ? scale_for(R, centered_cross(pairs), sq_x) : 1.0;
  if (result.has_baseline && !(s > 0.0)) {
    result.has_baseline = false;
    result.warnings.push_back("the session's path runs against the trajectory's: its scale is unusable");
  }
  result.T_world_session = with_scale(result, result.has_baseline ? s : 1.0);
  double sum_sq = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    sum_sq += (result.T_world_session * pairs.x[i] - pairs.y[i]).squaredNorm();
  result.position_rmse_m = std::sqrt(sum_sq * pairs.share());
  result.sigma_log_scale = std::numeric_limits<double>::infinity();
  if (!result.has_baseline) return;
  const double degrees_left = 3.0 * static_cast<double>(pairs.size()) - 7.0;
  const double sigma_m = degrees_left > 0.0 ? std::sqrt(sum_sq / degrees_left) : options.sigma_position_m;
  result.sigma_log_scale = std::max(options.least_sigma_log_scale, sigma_m / (s * std::sqrt(sq_x)));
}

void require(bool holds, const char* field, double value, const char* rule) {
  if (!holds) throw UsageError(fmt::format("{} is {:g}: {}", field, value, rule));
}

}  // namespace

void check_options(const SessionPlacementOptions& o) {
  require(o.linearity_threshold >= 0.0 && o.linearity_threshold <= 1.0, "linearity_threshold", o.linearity_threshold,
          "between 0 and 1 expected");
  const auto positive = [](const char* field, double value) {
    require(value > 0.0 && std::isfinite(value), field, value, "a positive number expected");
  };
  positive("min_spread_m", o.min_spread_m);
  positive("sigma_position_m", o.sigma_position_m);
  positive("sigma_rotation_deg", o.sigma_rotation_deg);
  positive("cauchy_deg", o.cauchy_deg);
  require(o.cauchy_passes >= 0, "cauchy_passes", o.cauchy_passes, "0 or more expected");
  positive("least_sigma_log_scale", o.least_sigma_log_scale);
  require(o.sigma_extrinsic_deg >= 0.0, "sigma_extrinsic_deg", o.sigma_extrinsic_deg, "0 or more expected");
}

SessionPlacement place_session(std::span<const SessionFrame> frames,
                               std::span<const std::optional<Eigen::Isometry3d>> T_world_camera,
                               const SessionPlacementOptions& options) {
  check_options(options);
  const PairedFrames pairs = paired(frames, T_world_camera);
  SessionPlacement result;
  result.n_pairs = pairs.size();
  result.mean_session = pairs.x_mean;
  result.mean_world = pairs.y_mean;
  const Eigen::Vector3d variances = principal_variances(pairs.y, pairs.y_mean);
  result.has_baseline = variances[2] >= options.min_spread_m * options.min_spread_m && sum_sq_x(pairs) > 0.0;
  if (!result.has_baseline) {
    result.warnings.push_back(fmt::format("no baseline: the camera centers spread by {:.3g} m; the scale is unusable",
                                          std::sqrt(variances[2])));
  } else {
    result.linearity = linearity_of(variances);
    result.umeyama = umeyama_if_determined(pairs, result.warnings);
  }
  result.session_linearity = linearity_of(principal_variances(pairs.x, pairs.x_mean));
  const Eigen::Matrix3d R = chosen_rotation(pairs, result, options);
  result.T_world_session.rotation = R;
  find_scale(pairs, options, result);
  if (result.umeyama) {
    result.correction_deg = rotation_angle_rad(result.umeyama->rotation.transpose() * R) / kDegree_rad;
  }
  double sum_sq_rad = 0.0;
  for (const Eigen::Matrix3d& turn : pairs.turns) sum_sq_rad += std::pow(rotation_angle_rad(R.transpose() * turn), 2);
  result.rotation_rmse_deg = std::sqrt(sum_sq_rad * pairs.share()) / kDegree_rad;
  return result;
}

Similarity with_scale(const SessionPlacement& placement, double scale) {
  const Eigen::Matrix3d& R = placement.T_world_session.rotation;
  return {scale, R, placement.mean_world - scale * (R * placement.mean_session)};
}

}  // namespace cmap
