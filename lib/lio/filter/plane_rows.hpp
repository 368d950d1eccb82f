#pragma once

#include <Eigen/Core>

#include "filter/nav_state.hpp"

namespace cmap {

using PoseVector = Eigen::Matrix<double, 6, 1>;
using PoseMatrix = Eigen::Matrix<double, 6, 6>;

/// A point's distance to a plane as a function of the pose at the scan's end: one row of the measurement.
struct PlaneRow {
  double residual_m = 0.0;
  double variance_m2 = 0.0;
  PoseVector jacobian = PoseVector::Zero();  ///< of the residual by the errors of rotation and position
};

/// @param normal   of the plane, world
/// @param arm_end  from the body's origin to the point, both at the point's time, in the body's axes at the end
/// @param share    of a change of the pose at the end there is at the point's time (MotionTrack::share_at)
inline PoseVector plane_jacobian(const Eigen::Matrix3d& R_end, const Eigen::Vector3d& normal,
                                 const Eigen::Vector3d& arm_end, double share) {
  PoseVector jacobian;
  jacobian << share * arm_end.cross(R_end.transpose() * normal), share * normal;
  return jacobian;
}

/// Sums of rows, each by the inverse of its variance: the normal equations J^T J x = -J^T r.
struct PlaneSystem {
  PoseMatrix information = PoseMatrix::Zero();
  PoseVector gradient = PoseVector::Zero();
  std::size_t n = 0;

  void add(const PlaneRow& row, double weight) {
    const double w = weight / row.variance_m2;
    information += (w * row.jacobian) * row.jacobian.transpose();
    gradient += w * row.residual_m * row.jacobian;
    ++n;
  }
};

/// One Gauss-Newton step of an iterated Kalman update: the change of `estimate` that minimizes the prior
/// |estimate - predicted|^2 by the covariance plus the rows (Bell and Cathey 1993). `covariance` becomes that of the
/// result, for rows taken at it.
StateVector kalman_step(const NavState& estimate, const NavState& predicted, const StateMatrix& predicted_covariance,
                        const PlaneSystem& system, StateMatrix& covariance);

}  // namespace cmap
