#pragma once

#include "filter/nav_state.hpp"

namespace cmap {

/// How the body moved over a short time.
struct MotionInput {
  double duration_s = 0.0;
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();  ///< body; the gyro's bias is taken off
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();  ///< body; the accelerometer's bias is taken off
  bool rate_measured = true;                             ///< false: the rate is a guess, with the noise of one
  bool force_measured = true;  ///< false: the velocity is taken for constant, with the noise of that
};

/// Densities of white noise, all per square root of a second (or of a hertz).
struct MotionNoise {
  double rate = 2e-3;             ///< rad/s/sqrt(Hz)
  double force = 5e-2;            ///< m/s^2/sqrt(Hz)
  double gyro_bias_walk = 1e-4;   ///< rad/s^2/sqrt(Hz)
  double force_bias_walk = 1e-3;  ///< m/s^3/sqrt(Hz)
  double free_rate = 0.15;        ///< rad/s/sqrt(Hz): of a guess
  double free_force = 1.5;        ///< m/s^2/sqrt(Hz): of a constant velocity
};

/// The state after it. One step of the midpoint rule: the force turns with the body's attitude in the middle,
///   p+ = p + v dt + a dt^2 / 2,  v+ = v + a dt,  R+ = R Exp(w dt),  a = R Exp(w dt / 2) (f - b_a) + g,  w = rate -
///   b_g.
NavState propagated(const NavState& state, const MotionInput& input);

/// Derivative of the error after the step by the error before it.
StateMatrix propagation_jacobian(const NavState& state, const MotionInput& input);

/// Covariance after the step, symmetric.
StateMatrix propagated_covariance(const NavState& state, const StateMatrix& covariance, const MotionInput& input,
                                  const MotionNoise& noise);

}  // namespace cmap
