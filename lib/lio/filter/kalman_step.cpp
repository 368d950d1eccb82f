#include <Eigen/Cholesky>

#include "filter/plane_rows.hpp"

namespace cmap {

StateVector kalman_step(const NavState& estimate, const NavState& predicted, const StateMatrix& predicted_covariance,
                        const PlaneSystem& system, StateMatrix& covariance) {
  const StateVector from_predicted = difference(estimate, predicted);
  // The difference after a further small change d of the estimate is from_predicted + J d.
  StateMatrix J = StateMatrix::Identity();
  J.block<3, 3>(part::kRotation, part::kRotation) = inverse_right_jacobian(from_predicted.segment<3>(part::kRotation));
  const StateMatrix prior = predicted_covariance.llt().solve(StateMatrix::Identity());
  StateMatrix information = J.transpose() * prior * J;
  StateVector gradient = J.transpose() * (prior * from_predicted);
  information.topLeftCorner<6, 6>() += system.information;
  gradient.head<6>() += system.gradient;
  covariance = information.llt().solve(StateMatrix::Identity());
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  return -(covariance * gradient);
}

}  // namespace cmap
