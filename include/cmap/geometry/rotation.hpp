#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace cmap {

/// The rotation nearest to a matrix in the sense of least squares (its polar factor, determinant +1).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

/// Largest entry of |R^T R - I|; infinite where det R <= 0 or an entry is not finite, as no rotation is meant then.
double deviation_from_rotation(const Eigen::Matrix3d& matrix);

/// Angle of a rotation in [0, pi]; exact also for tiny angles.
double rotation_angle_rad(const Eigen::Matrix3d& rotation);

/// The rotation by |axis_angle_rad| about that axis.
Eigen::Matrix3d rotation_from(const Eigen::Vector3d& axis_angle_rad);

// Logarithms and their derivatives (Sola et al. 2018, "A micro Lie theory"); inline, as solvers differentiate them.

inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

inline Eigen::Quaterniond rotation_exp(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  // sin(a/2)/a; the series is exact to 1e-17 there.
  const double factor = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = factor * phi;
  return q.normalized();
}

/// Axis times angle in [0, pi] of a unit quaternion of either sign.
inline Eigen::Vector3d rotation_log(const Eigen::Quaterniond& q) {
  const double sine = q.vec().norm();
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  if (sine < 1e-10) return 2.0 * sign * q.vec();
  return (2.0 * sign * std::atan2(sine, std::abs(q.w())) / sine) * q.vec();
}

/// d Log(Exp(phi) Exp(d)) / dd at d = 0.
inline Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& phi) {
  const double sq_angle = phi.squaredNorm();
  const double half = 0.5 * std::sqrt(sq_angle);
  const double factor =
      sq_angle < 1e-6 ? 1.0 / 12.0 + sq_angle / 720.0 : (1.0 - half * std::cos(half) / std::sin(half)) / sq_angle;
  const Eigen::Matrix3d cross = cross_matrix(phi);
  return Eigen::Matrix3d::Identity() + 0.5 * cross + factor * cross * cross;
}

/// Exp(phi + d) = Exp(phi) Exp(J d) to first order.
inline Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& phi) {
  const double sq_angle = phi.squaredNorm();
  const double angle = std::sqrt(sq_angle);
  const double first = sq_angle < 1e-6 ? 0.5 - sq_angle / 24.0 : (1.0 - std::cos(angle)) / sq_angle;
  const double second = sq_angle < 1e-6 ? 1.0 / 6.0 - sq_angle / 120.0 : (angle - std::sin(angle)) / (sq_angle * angle);
  const Eigen::Matrix3d cross = cross_matrix(phi);
  return Eigen::Matrix3d::Identity() - first * cross + second * cross * cross;
}

}  // namespace cmap
