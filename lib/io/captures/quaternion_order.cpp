#include "captures/quaternion_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cmap {
namespace {

/// A world whose forces point farther from up than the first, in one order, and nearer than the second in the other.
constexpr double kWrong_deg = 30.0, kRight_deg = 10.0;

/// A quaternion whose numbers were w x y z and were read as x y z w.
Eigen::Quaterniond reordered(const Eigen::Quaterniond& read) { return {read.x(), read.y(), read.z(), read.w()}; }

double from_up_deg(const Eigen::Vector3d& force) {
  return std::acos(std::clamp(force.normalized().z(), -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

}  // namespace

std::string quaternion_order_fault(const Trajectory& world_T_imu, std::span<const ImuSample> imu) {
  Eigen::Vector3d as_read = Eigen::Vector3d::Zero(), other = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : imu) {
    const auto pose = std::ranges::lower_bound(world_T_imu, sample.time_s, {}, &StampedPose::time_s);
    if (pose == world_T_imu.end() || pose == world_T_imu.begin()) continue;
    as_read += pose->rotation * sample.specific_force_mps2;
    other += reordered(pose->rotation) * sample.specific_force_mps2;
  }
  if (as_read.isZero() || from_up_deg(as_read) < kWrong_deg || from_up_deg(other) > kRight_deg) return "";
  return fmt::format(
      "by gravity the quaternions are in the order w x y z, not x y z w: the IMU's mean force points {:.0f} "
      "deg from up as they are, {:.0f} deg in that order",
      from_up_deg(as_read), from_up_deg(other));
}

}  // namespace cmap
