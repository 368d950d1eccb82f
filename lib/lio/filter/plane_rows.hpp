#pragma once

#include <Eigen/Core>

#include "filter/nav_state.hpp"

namespace cmap {

/// A point's distance to a plane as a function of the state at the scan's end: one row of the measurement.
struct PlaneRow {
  double residual_m = 0.0;
  double variance_m2 = 0.0;
  /// Of the residual by the errors of rotation, position, velocity and gyro bias, in that order.
  Eigen::Matrix<double, 12, 1> jacobian;
};

/// @param normal      of the plane, world
/// @param arm_end     from the body's origin to the point, both at the point's time, in the body's axes at the end
/// @param before_end  of the point's time, s
/// The world point is R_end arm_end + p(t), and a change of the state at the end reaches back to p(t) and the turn as
/// MotionTrack says.
inline Eigen::Matrix<double, 12, 1> plane_jacobian(const Eigen::Matrix3d& R_end, const Eigen::Vector3d& normal,
                                                   const Eigen::Vector3d& arm_end, double before_end_s) {
  const Eigen::Vector3d turn = arm_end.cross(R_end.transpose() * normal);
  Eigen::Matrix<double, 12, 1> jacobian;
  jacobian << turn, normal, -before_end_s * normal, before_end_s * turn;
  return jacobian;
}

/// Sums of rows, each by the inverse of its variance: the normal equations J^T J x = -J^T r.
struct PlaneSystem {
  Eigen::Matrix<double, 12, 12> information = Eigen::Matrix<double, 12, 12>::Zero();
  Eigen::Matrix<double, 12, 1> gradient = Eigen::Matrix<double, 12, 1>::Zero();
  double sq_sum = 0.0;  ///< of residuals over their standard deviations
  std::size_t n = 0;

  void add(const PlaneRow& row, double weight) {
    const double w = weight / row.variance_m2;
    information.selfadjointView<Eigen::Lower>().rankUpdate(row.jacobian, w);
    gradient += w * row.residual_m * row.jacobian;
    sq_sum += w * row.residual_m * row.residual_m;
    ++n;
  }
};

/// One Gauss-Newton step of an iterated Kalman update: the change of `estimate` that minimizes the prior
/// |estimate - predicted|^2 by the covariance plus the rows (Bell and Cathey 1993). `covariance` becomes that of the
/// result, for rows taken at it.
StateVector kalman_step(const NavState& estimate, const NavState& predicted, const StateMatrix& predicted_covariance,
                        const PlaneSystem& system, StateMatrix& covariance);

}  // namespace cmap
