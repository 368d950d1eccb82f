#pragma once

#include <Eigen/Geometry>

#include "cmap/geometry/imu_sample.hpp"
#include "cmap/geometry/rotation.hpp"

namespace cmap {

/// What the filter knows of the body (the IMU's frame) in the world. Errors are small changes in the order of Part:
/// the rotation's on the right (R Exp(theta)), all others are added.
struct NavState {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< world from body
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            ///< m/s, world
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< rad/s
  Eigen::Vector3d force_bias = Eigen::Vector3d::Zero();          ///< of the accelerometer, m/s^2
  Eigen::Vector3d gravity{0.0, 0.0, -kStandardGravity_mps2};     ///< m/s^2, world
};

/// Where the errors of each part begin.
namespace part {
inline constexpr int kRotation = 0, kPosition = 3, kVelocity = 6, kGyroBias = 9, kForceBias = 12, kGravity = 15,
                     kAll = 18;
}  // namespace part

using StateVector = Eigen::Matrix<double, part::kAll, 1>;
using StateMatrix = Eigen::Matrix<double, part::kAll, part::kAll>;

inline NavState moved(const NavState& state, const StateVector& by) {
  NavState result = state;
  result.rotation = (state.rotation * rotation_exp(by.segment<3>(part::kRotation))).normalized();
  result.position += by.segment<3>(part::kPosition);
  result.velocity += by.segment<3>(part::kVelocity);
  result.gyro_bias += by.segment<3>(part::kGyroBias);
  result.force_bias += by.segment<3>(part::kForceBias);
  result.gravity += by.segment<3>(part::kGravity);
  return result;
}

/// The change that moved() takes from `from` to `to`.
inline StateVector difference(const NavState& to, const NavState& from) {
  StateVector change;
  change << rotation_log(from.rotation.conjugate() * to.rotation), to.position - from.position,
      to.velocity - from.velocity, to.gyro_bias - from.gyro_bias, to.force_bias - from.force_bias,
      to.gravity - from.gravity;
  return change;
}

inline Eigen::Isometry3d T_world_body(const NavState& state) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = state.rotation.toRotationMatrix();
  T.translation() = state.position;
  return T;
}

}  // namespace cmap
