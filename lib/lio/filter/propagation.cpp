#include "filter/propagation.hpp"

namespace cmap {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Terms of a step that state and derivative share.
struct Step {
  double dt;
  Vector3d turn;        ///< w dt
  Vector3d half_force;  ///< the force, without its bias, in the body's axes at the beginning
  Matrix3d R, half_turn;

  Step(const NavState& state, const MotionInput& input) : dt(input.duration_s) {
    turn = (input.rate_radps - state.gyro_bias) * dt;
    R = state.rotation.toRotationMatrix();
    half_turn = rotation_exp(0.5 * turn).toRotationMatrix();
    half_force = half_turn * (input.force_mps2 - state.force_bias);
  }
};

StateMatrix noise_covariance(const MotionInput& input, const MotionNoise& noise) {
  const double dt = input.duration_s;
  const auto variance = [&](double density) { return density * density * dt; };
  const double force = variance(input.force_measured ? noise.force : noise.free_force);
  const Matrix3d I = Matrix3d::Identity();
  StateMatrix Q = StateMatrix::Zero();
  Q.block<3, 3>(part::kRotation, part::kRotation) = variance(input.rate_measured ? noise.rate : noise.free_rate) * I;
  // White acceleration: variances dt^3 / 3 and dt, covariance dt^2 / 2 of its density squared.
  Q.block<3, 3>(part::kPosition, part::kPosition) = force * dt * dt / 3.0 * I;
  Q.block<3, 3>(part::kPosition, part::kVelocity) = force * dt / 2.0 * I;
  Q.block<3, 3>(part::kVelocity, part::kPosition) = force * dt / 2.0 * I;
  Q.block<3, 3>(part::kVelocity, part::kVelocity) = force * I;
  Q.block<3, 3>(part::kGyroBias, part::kGyroBias) = variance(noise.gyro_bias_walk) * I;
  Q.block<3, 3>(part::kForceBias, part::kForceBias) = variance(noise.force_bias_walk) * I;
  return Q;
}

}  // namespace

NavState propagated(const NavState& state, const MotionInput& input) {
  const Step step(state, input);
  const Vector3d acceleration =
      input.force_measured ? Vector3d(step.R * step.half_force + state.gravity) : Vector3d::Zero();
  NavState next = state;
  next.rotation = (state.rotation * rotation_exp(step.turn)).normalized();
  next.position += step.dt * state.velocity + 0.5 * step.dt * step.dt * acceleration;
  next.velocity += step.dt * acceleration;
  return next;
}

StateMatrix propagation_jacobian(const NavState& state, const MotionInput& input) {
  const Step step(state, input);
  const double dt = step.dt;
  const Matrix3d I = Matrix3d::Identity();
  StateMatrix F = StateMatrix::Identity();
  F.block<3, 3>(part::kRotation, part::kRotation) = rotation_exp(-step.turn).toRotationMatrix();
  F.block<3, 3>(part::kPosition, part::kVelocity) = dt * I;
  F.block<3, 3>(part::kRotation, part::kGyroBias) = -dt * right_jacobian(step.turn);
  if (!input.force_measured) return F;
  const auto set_acceleration = [&](int column, const Matrix3d& by) {
    F.block<3, 3>(part::kVelocity, column) = dt * by;
    F.block<3, 3>(part::kPosition, column) = 0.5 * dt * dt * by;
  };
  const Vector3d force = input.force_mps2 - state.force_bias;
  set_acceleration(part::kRotation, -step.R * cross_matrix(step.half_force));
  set_acceleration(part::kGyroBias,
                   step.R * step.half_turn * cross_matrix(force) * right_jacobian(0.5 * step.turn) * (0.5 * dt));
  set_acceleration(part::kForceBias, -step.R * step.half_turn);
  set_acceleration(part::kGravity, I);
  return F;
}

StateMatrix propagated_covariance(const NavState& state, const StateMatrix& covariance, const MotionInput& input,
                                  const MotionNoise& noise) {
  const StateMatrix F = propagation_jacobian(state, input);
  StateMatrix next = F * covariance * F.transpose() + noise_covariance(input, noise);
  return 0.5 * (next + next.transpose());
}

}  // namespace cmap
