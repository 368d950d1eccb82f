#include "odometry/start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cmap/align/icp.hpp"
#include "cmap/core/error.hpp"

namespace cmap {
namespace {

constexpr int kPasses = 3;
constexpr double kDegree = std::numbers::pi / 180.0;
/// Of two registered scans: less is rest. Sensors that never look the same way twice (rosettes) seem to move by
/// centimeters while they stand.
constexpr double kRestSpeed_mps = 0.25, kRestRate_radps = 3.0 * kDegree;
/// An IMU whose rates and forces vary by less, in standard deviations, stands or glides; it stands, if registration
/// says no more than this.
constexpr double kQuietRate_radps = 0.6 * kDegree, kQuietForce_mps2 = 0.1, kQuietSpeed_mps = 3.0;

/// A steady motion, in the body's axes at a scan's end.
struct Twist {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();

  Eigen::Isometry3d over(double seconds) const {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = rotation_exp(seconds * rate).toRotationMatrix();
    T.translation() = seconds * velocity;
    return T;
  }
};

/// The scan as seen from the body at the scan's end.
PointCloud compensated(const ScanPoints& scan, const Twist& twist, const Eigen::Isometry3d& T_imu_lidar) {
  PointCloud cloud;
  cloud.positions.reserve(scan.positions.size());
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const Eigen::Isometry3d T = twist.over(-static_cast<double>(scan.before_end_s[i])) * T_imu_lidar;
    cloud.positions.push_back((T * scan.positions[i].cast<double>()).cast<float>());
  }
  return cloud;
}

/// The motion between the ends of two scans by registration; the one given where that cannot tell.
Twist registered_twist(const ScanPoints& first, const ScanPoints& second, const Twist& twist,
                       const Eigen::Isometry3d& T_imu_lidar, const OdometryOptions& options) {
  const double dt = second.end_s - first.end_s;
  const PointCloud target = compensated(first, twist, T_imu_lidar), source = compensated(second, twist, T_imu_lidar);
  IcpOptions icp_options;
  icp_options.levels = coarse_to_fine(options.scan_voxel_m, 2.0 * options.scan_voxel_m);
  try {
    const Alignment found = icp(source, target, twist.over(dt).matrix(), icp_options);
    const Eigen::Quaterniond rotation(Eigen::Matrix3d(found.T_dst_src.topLeftCorner<3, 3>()));
    return {found.T_dst_src.topRightCorner<3, 1>() / dt, rotation_log(rotation) / dt};
  } catch (const UnsupportedError&) {
    return twist;
  }
}

Eigen::Vector3d mean_rate(std::span<const ImuSample> imu) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : imu) sum += sample.angular_rate_radps;
  return imu.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(imu.size()));
}

/// The mean force in the body's axes at a time.
Eigen::Vector3d mean_force(std::span<const ImuSample> imu, const Eigen::Vector3d& rate, double time_s) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : imu) {
    sum += rotation_exp((sample.time_s - time_s) * rate) * sample.specific_force_mps2;
  }
  return sum / static_cast<double>(imu.size());
}

/// Root of the mean squared deviation from the mean.
double spread(std::span<const ImuSample> imu, Eigen::Vector3d ImuSample::*member) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : imu) sum += sample.*member;
  const Eigen::Vector3d mean = sum / static_cast<double>(imu.size());
  double sq_sum = 0.0;
  for (const ImuSample& sample : imu) sq_sum += (sample.*member - mean).squaredNorm();
  return std::sqrt(sq_sum / (3.0 * static_cast<double>(imu.size())));
}

bool is_at_rest(const Twist& twist, std::span<const ImuSample> imu) {
  if (twist.velocity.norm() < kRestSpeed_mps && twist.rate.norm() < kRestRate_radps) return true;
  constexpr std::size_t kEnough = 10;
  if (imu.size() < kEnough || twist.velocity.norm() > kQuietSpeed_mps) return false;
  return spread(imu, &ImuSample::angular_rate_radps) < kQuietRate_radps && mean_rate(imu).norm() < kRestRate_radps &&
         spread(imu, &ImuSample::specific_force_mps2) < kQuietForce_mps2;
}

/// Upright by the force, heading along x.
Eigen::Quaterniond leveled(const Eigen::Vector3d& force) {
  const auto upright = Eigen::Quaterniond::FromTwoVectors(force, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d ahead = upright * Eigen::Vector3d::UnitX();
  return rotation_exp({0.0, 0.0, -std::atan2(ahead.y(), ahead.x())}) * upright;
}

/// @param speed_mps  by registration; at rest by the IMU it is what the start may be wrong by
StateMatrix start_covariance(bool with_imu, bool in_motion, double speed_mps) {
  StateVector deviations;
  const auto set = [&](int first, double deviation) { deviations.segment<3>(first).setConstant(deviation); };
  set(part::kRotation, 1e-4);
  set(part::kPosition, 1e-4);
  set(part::kVelocity, in_motion ? 0.3 : std::max(0.05, 0.3 * speed_mps));
  set(part::kGyroBias, !with_imu ? 0.1 : in_motion ? 0.01 : 0.003);
  set(part::kForceBias, with_imu ? 0.05 : 1e-3);
  set(part::kGravity, !with_imu ? 1e-3 : in_motion ? 0.5 : 0.05);
  return StateMatrix(deviations.array().square().matrix().asDiagonal());
}

/// @param registered  the motion by registration; counts where it is one
Start make_start(const ScanPoints& first, std::span<const ImuSample> imu, const Twist& registered, bool in_motion,
                 const std::optional<Eigen::Isometry3d>& T_world_start) {
  const Twist twist = in_motion ? registered : Twist{};
  Start start;
  start.in_motion = in_motion;
  start.covariance = start_covariance(!imu.empty(), in_motion, registered.velocity.norm());
  NavState& state = start.at_begin;
  const Eigen::Vector3d force =
      imu.empty() ? Eigen::Vector3d(0.0, 0.0, kStandardGravity_mps2) : mean_force(imu, twist.rate, first.begin_s);
  if (T_world_start) {
    state.rotation = Eigen::Quaterniond(T_world_start->linear());
    state.position = T_world_start->translation();
  } else if (!imu.empty()) {
    state.rotation = leveled(force);
  }
  state.gravity = -kStandardGravity_mps2 * (state.rotation * force.normalized());
  if (imu.empty()) {
    state.gyro_bias = -twist.rate;
  } else if (!in_motion) {
    state.gyro_bias = mean_rate(imu);
  }
  const double duration_s = first.end_s - first.begin_s;
  const Eigen::Isometry3d T_begin_end = twist.over(-duration_s).inverse();
  start.state = state;
  start.state.rotation = (state.rotation * Eigen::Quaterniond(T_begin_end.linear())).normalized();
  start.state.position += state.rotation * T_begin_end.translation();
  start.state.velocity = start.at_begin.velocity = start.state.rotation * twist.velocity;
  return start;
}

}  // namespace

Start find_start(const ScanPoints& first, const ScanPoints& second, std::span<const ImuSample> imu,
                 const Eigen::Isometry3d& T_imu_lidar, const std::optional<Eigen::Isometry3d>& T_world_start,
                 const OdometryOptions& options) {
  Twist twist;
  if (!imu.empty()) twist.rate = mean_rate(imu);
  for (int pass = 0; pass < kPasses; ++pass) {
    twist = registered_twist(first, second, twist, T_imu_lidar, options);
  }
  const bool in_motion = !is_at_rest(twist, imu);
  return make_start(first, imu, twist, in_motion, T_world_start);
}

Start start_at_rest(const ScanPoints& first, std::span<const ImuSample> imu,
                    const std::optional<Eigen::Isometry3d>& T_world_start) {
  return make_start(first, imu, {}, false, T_world_start);
}

}  // namespace cmap
