#include "filter/propagation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace cmap {
namespace propagation_test {

using Eigen::Vector3d;

constexpr double kRadius_m = 5.0, kTurn_radps = 1.0;
const Vector3d kGyroBias(0.01, -0.02, 0.03), kForceBias(0.1, 0.2, -0.3);

/// On a circle in a tilted plane, facing along it: the state at a time, in closed form.
NavState on_circle(double t) {
  const Eigen::Quaterniond tilt = rotation_exp({0.3, -0.2, 0.5});
  const double a = kTurn_radps * t;
  NavState state;
  state.position = tilt * (kRadius_m * Vector3d(std::cos(a), std::sin(a), 0.0));
  state.velocity = tilt * (kRadius_m * kTurn_radps * Vector3d(-std::sin(a), std::cos(a), 0.0));
  state.rotation = tilt * rotation_exp({0.0, 0.0, a + 0.5 * M_PI});
  state.gyro_bias = kGyroBias;
  state.force_bias = kForceBias;
  // Along the circle's axis, so that the force in the body's axes is constant.
  state.gravity = tilt * Vector3d(0.0, 0.0, -9.81);
  return state;
}

/// What an IMU with those biases measures there.
MotionInput circle_input(double dt) {
  return {.duration_s = dt,
          .rate_radps = Vector3d(0.0, 0.0, kTurn_radps) + kGyroBias,
          .force_mps2 = Vector3d(0.0, kTurn_radps * kTurn_radps * kRadius_m, 9.81) + kForceBias};
}

NavState after_ten_seconds(double dt) {
  NavState state = on_circle(0.0);
  const int n = static_cast<int>(std::lround(10.0 / dt));
  for (int i = 0; i < n; ++i) state = propagated(state, circle_input(dt));
  return state;
}

TEST(Propagation, FollowsACircle) {
  const NavState truth = on_circle(10.0), found = after_ten_seconds(0.005);
  // The rule turns a constant rate exactly.
  EXPECT_LT(found.rotation.angularDistance(truth.rotation), 1e-11);
  // A force in the middle of a turn is short by (w dt)^2 / 24 of the mean: 5 m/s^2 by 1e-6, in 10 s 1e-5 m/s; positions
  // gather that over 10 s.
  EXPECT_LT((found.velocity - truth.velocity).norm(), 2e-5);
  EXPECT_LT((found.position - truth.position).norm(), 2e-4);
}

TEST(Propagation, ErrorsShrinkWithTheSquareOfTheStep) {
  const NavState truth = on_circle(10.0);
  const auto errors = [&](double dt) {
    const NavState found = after_ten_seconds(dt);
    return std::pair((found.position - truth.position).norm(), (found.velocity - truth.velocity).norm());
  };
  const auto [coarse_position, coarse_velocity] = errors(0.04);
  const auto [fine_position, fine_velocity] = errors(0.02);
  // Of second order: four times, up to the next term, (w dt)^2.
  EXPECT_NEAR(coarse_position / fine_position, 4.0, 0.05);
  EXPECT_NEAR(coarse_velocity / fine_velocity, 4.0, 0.05);
}

TEST(Propagation, WithoutForceTheVelocityStays) {
  NavState state = on_circle(0.0);
  MotionInput input = circle_input(0.5);
  input.force_measured = false;
  const NavState next = propagated(state, input);
  EXPECT_EQ(next.velocity, state.velocity);
  EXPECT_LT((next.position - state.position - 0.5 * state.velocity).norm(), 1e-15);
}

NavState some_state() {
  NavState state = on_circle(0.7);
  state.gravity = {0.3, -0.2, -9.7};
  return state;
}

StateMatrix numeric_jacobian(const NavState& state, const MotionInput& input) {
  const double step = 1e-5;
  const NavState base = propagated(state, input);
  StateMatrix F;
  for (int i = 0; i < part::kAll; ++i) {
    const StateVector d = step * StateVector::Unit(i);
    F.col(i) =
        (difference(propagated(moved(state, d), input), base) - difference(propagated(moved(state, -d), input), base)) /
        (2.0 * step);
  }
  return F;
}

TEST(Propagation, JacobianIsTheDerivative) {
  for (const double dt : {1e-3, 5e-3, 0.1}) {
    for (const double rate : {0.0, 0.1, 6.0}) {
      for (const bool measured : {true, false}) {
        const MotionInput input{.duration_s = dt,
                                .rate_radps = kGyroBias + rate * Vector3d(0.6, -0.64, 0.48),
                                .force_mps2 = {3.0, -4.0, 11.0},
                                .force_measured = measured};
        const StateMatrix F = propagation_jacobian(some_state(), input);
        // Differences are exact to step^2 = 1e-10 times third derivatives.
        EXPECT_LT((F - numeric_jacobian(some_state(), input)).cwiseAbs().maxCoeff(), 1e-8)
            << dt << " s, " << rate << " rad/s, " << measured;
      }
    }
  }
}

TEST(Propagation, FreeMotionSpreadsAsWhiteAccelerationDoes) {
  const MotionInput input{.duration_s = 2.0, .force_measured = false};
  const MotionNoise noise{.rate = 0.1, .gyro_bias_walk = 0.0, .force_bias_walk = 0.0, .free_force = 0.3};
  const StateMatrix P = propagated_covariance({}, StateMatrix::Zero(), input, noise);
  // 0.09 (m/s^2)^2/Hz over 2 s: t^3 / 3, t^2 / 2, t.
  EXPECT_NEAR(P(part::kPosition, part::kPosition), 0.09 * 8.0 / 3.0, 1e-14);
  EXPECT_NEAR(P(part::kPosition, part::kVelocity), 0.09 * 2.0, 1e-14);
  EXPECT_NEAR(P(part::kVelocity, part::kVelocity), 0.09 * 2.0, 1e-14);
  EXPECT_NEAR(P(part::kRotation, part::kRotation), 0.01 * 2.0, 1e-14);
  EXPECT_EQ(P(part::kPosition + 1, part::kVelocity), 0.0);
  StateMatrix steps = StateMatrix::Zero();
  for (int i = 0; i < 8; ++i) {
    steps = propagated_covariance({}, steps, {.duration_s = 0.25, .force_measured = false}, noise);
  }
  EXPECT_LT((steps - P).cwiseAbs().maxCoeff(), 1e-13) << "in steps as in one";
}

TEST(Propagation, GuessesAreAsNoisyAsTheySay) {
  const MotionNoise noise{.rate = 0.1, .free_rate = 0.5};
  const auto rotation_variance = [&](bool measured) {
    const MotionInput input{.duration_s = 1.0, .rate_measured = measured};
    return propagated_covariance({}, StateMatrix::Zero(), input, noise)(0, 0);
  };
  EXPECT_NEAR(rotation_variance(true), 0.01, 1e-15);
  EXPECT_NEAR(rotation_variance(false), 0.25, 1e-15);
}

TEST(Propagation, CovarianceStaysSymmetricAndPositive) {
  StateMatrix P = 1e-8 * StateMatrix::Identity();
  NavState state = on_circle(0.0);
  const MotionNoise noise;
  for (int i = 0; i < 2000; ++i) {
    P = propagated_covariance(state, P, circle_input(0.005), noise);
    state = propagated(state, circle_input(0.005));
    ASSERT_EQ(P, P.transpose()) << i;
  }
  EXPECT_EQ(P.llt().info(), Eigen::Success);
}

/// The spread of many runs with noise drawn for each.
struct Runs {
  int n = 20000, steps = 20;
  double dt = 0.01;
  MotionNoise noise{.rate = 0.02, .force = 0.5, .gyro_bias_walk = 0.01, .force_bias_walk = 0.1};
  StateMatrix P0;

  Runs() {
    StateVector deviations;
    deviations << Vector3d::Constant(0.01), Vector3d::Constant(0.1), Vector3d::Constant(0.2), Vector3d::Constant(0.02),
        Vector3d::Constant(0.1), Vector3d::Constant(0.05);
    P0 = deviations.array().square().matrix().asDiagonal();
  }
  StateMatrix predicted() const {
    StateMatrix P = P0;
    NavState state = on_circle(0.0);
    for (int i = 0; i < steps; ++i) {
      P = propagated_covariance(state, P, circle_input(dt), noise);
      state = propagated(state, circle_input(dt));
    }
    return P;
  }
  StateMatrix drawn() const {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    const auto draw = [&](double deviation) {
      return Vector3d(deviation * normal(random), deviation * normal(random), deviation * normal(random));
    };
    NavState mean = on_circle(0.0);
    for (int i = 0; i < steps; ++i) mean = propagated(mean, circle_input(dt));
    StateMatrix sum = StateMatrix::Zero();
    for (int run = 0; run < n; ++run) {
      StateVector begin;
      for (int i = 0; i < part::kAll; ++i) begin[i] = std::sqrt(P0(i, i)) * normal(random);
      NavState state = moved(on_circle(0.0), begin);
      for (int i = 0; i < steps; ++i) {
        MotionInput input = circle_input(dt);
        input.rate_radps += draw(noise.rate / std::sqrt(dt));
        input.force_mps2 += draw(noise.force / std::sqrt(dt));
        state = propagated(state, input);
        state.gyro_bias += draw(noise.gyro_bias_walk * std::sqrt(dt));
        state.force_bias += draw(noise.force_bias_walk * std::sqrt(dt));
      }
      const StateVector error = difference(state, mean);
      sum += error * error.transpose();
    }
    return sum / n;
  }
};

TEST(Propagation, CovarianceIsThatOfManyRuns) {
  const Runs runs;
  const StateMatrix P = runs.predicted(), drawn = runs.drawn();
  for (int i = 0; i < part::kAll; ++i) {
    for (int j = 0; j <= i; ++j) {
      // Of n draws the mean product is known to that deviation; five of them, and 2 % for what is not linear.
      const double deviation = std::sqrt((P(i, i) * P(j, j) + P(i, j) * P(i, j)) / runs.n);
      EXPECT_NEAR(drawn(i, j), P(i, j), 5.0 * deviation + 0.02 * std::abs(P(i, j))) << i << ", " << j;
    }
  }
}

TEST(NavState, DifferenceInvertsMoved) {
  StateVector by;
  for (int i = 0; i < part::kAll; ++i) by[i] = 0.1 * std::sin(1.0 + i);
  EXPECT_LT((difference(moved(some_state(), by), some_state()) - by).norm(), 1e-13);
}

}  // namespace propagation_test
}  // namespace cmap
