#include "odometry/scan_registration.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cmap {
namespace {

/// Surfaces that count less than so many points leave a direction open. Streets and rooms have 5 % of the matches and
/// more; of flights over fields half have less than 5, and those with less than 1 drift without the IMU.
constexpr double kLeastHeld = 1.0;
constexpr double kRotationDone_rad = 1e-5, kShiftDone_m = 1e-4;
/// Of the gate of the prediction's variance, what is left for the next step. Without an IMU hand-held turns would be
/// locked out before they have settled; with one, what is far from the prediction is rather wrong.
constexpr double kGateCloses = 0.25, kGateClosesWithoutImu = 0.8, kSettledGateCloses = 0.1;

/// One pass over the points: planes at the estimate, and the system that they make.
class MatchingPass {
 public:
  MatchingPass(const PlaneMap& map, const OdometryOptions& options, const NavState& estimate, const PoseMatrix& prior)
      : map_(map), options_(options), R_end_(estimate.rotation.toRotationMatrix()), prior_(prior) {}

  void add(const Eigen::Vector3f& point, const ScanPoses::Pose& pose) {
    const Eigen::Vector3d p = point.cast<double>(), world = pose.T_world_lidar * p;
    PlaneRow row;
    const Plane* plane = match(map_.find(world), p, world, pose, row);
    if (plane == nullptr) plane = match(map_.find_beside(world), p, world, pose, row);
    if (plane == nullptr) return;
    // Cauchy's weight: what is three standard deviations off counts a tenth.
    const double sq_deviations = row.residual_m * row.residual_m / row.variance_m2;
    system.add(row, 1.0 / (1.0 + sq_deviations));
    sq_sum_m2 += row.residual_m * row.residual_m;
    directions.add(plane->normal, row.jacobian, std::max(plane->long_slope_variance, plane->short_slope_variance));
  }

  PlaneSystem system;
  PlaneDirections directions;
  double sq_sum_m2 = 0.0;

 private:
  const Plane* match(const Plane* plane, const Eigen::Vector3d& p, const Eigen::Vector3d& world,
                     const ScanPoses::Pose& pose, PlaneRow& row) const {
    if (plane == nullptr) return nullptr;
    const Eigen::Vector3d normal = plane->normal.cast<double>();
    const Eigen::Vector3f from_center = (world - plane->center).cast<float>();
    const float along = plane->long_axis.dot(from_center), beside = plane->short_axis.dot(from_center);
    if (along * along > 9.0f * plane->long_variance || beside * beside > 9.0f * plane->short_variance + 0.01f)
      return nullptr;
    row.residual_m = normal.dot(world - plane->center);
    row.variance_m2 = options_.model_noise_m * options_.model_noise_m + plane->variance_at(from_center) +
                      point_variance_m2(p, pose.T_world_lidar.linear().transpose() * normal, options_);
    const Eigen::Vector3d arm = R_end_.transpose() * (world - pose.body_position);
    row.jacobian = plane_jacobian(R_end_, normal, arm, pose.share);
    const double gate_m2 = row.variance_m2 + row.jacobian.dot(prior_ * row.jacobian);
    if (row.residual_m * row.residual_m > options_.gate * options_.gate * gate_m2) return nullptr;
    return plane;
  }

  const PlaneMap& map_;
  const OdometryOptions& options_;
  Eigen::Matrix3d R_end_;
  const PoseMatrix& prior_;
};

/// What the prediction's variance allows a point some way off, m^2.
double gate_m2(const PoseMatrix& prior) {
  constexpr double kReach_m = 20.0;
  return prior.diagonal().tail<3>().maxCoeff() + kReach_m * kReach_m * prior.diagonal().head<3>().maxCoeff();
}

bool is_small(const StateVector& change) {
  return change.segment<3>(part::kRotation).norm() < kRotationDone_rad &&
         change.segment<3>(part::kPosition).norm() < kShiftDone_m;
}

}  // namespace

double point_variance_m2(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, const OdometryOptions& options) {
  const double sq_range = point.squaredNorm();
  const double beam = options.beam_noise_deg * std::numbers::pi / 180.0;
  const double across = normal.dot(point);
  const double sq_cosine = sq_range > 0.0 ? across * across / sq_range : 1.0;
  return options.range_noise_m * options.range_noise_m * sq_cosine + beam * beam * sq_range * (1.0 - sq_cosine);
}

ScanRegistration register_scan(const PlaneMap& map, const ScanPoints& scan, std::span<const std::uint32_t> chosen,
                               const MotionTrack& track, const StateMatrix& predicted_covariance,
                               const Eigen::Isometry3d& T_body_lidar, const OdometryOptions& options) {
  ScanRegistration result;
  result.state = track.predicted();
  result.covariance = predicted_covariance;
  result.n_points = chosen.size();
  PoseMatrix gate = predicted_covariance.topLeftCorner<6, 6>();
  for (result.iterations = 0; result.iterations < options.iterations;) {
    ++result.iterations;
    const ScanPoses poses(track, result.state, T_body_lidar, scan.end_s - scan.begin_s);
    MatchingPass pass(map, options, result.state, gate);
    for (const std::uint32_t i : chosen) pass.add(scan.positions[i], poses.at(scan.before_end_s[i]));
    result.n_matches = pass.system.n;
    if (result.n_matches == 0) return result;
    result.rms_m = std::sqrt(pass.sq_sum_m2 / static_cast<double>(result.n_matches));
    result.open = open_directions(pass.directions, kLeastHeld);
    if (result.open.any()) remove_open(pass.system, result.open);
    const StateVector change =
        kalman_step(result.state, track.predicted(), predicted_covariance, pass.system, result.covariance);
    result.state = moved(result.state, change);
    const bool settled = is_small(change);
    if (settled && gate_m2(gate) < options.model_noise_m * options.model_noise_m) break;
    // What the first steps found need not be settled yet; what is settled, matches that the prediction alone allowed
    // may have held.
    gate *= settled ? kSettledGateCloses : options.use_imu ? kGateCloses : kGateClosesWithoutImu;
  }
  return result;
}

}  // namespace cmap
