#include "cmap/sim/pose_spline.hpp"

#include <random>
#include <stdexcept>

#include "sim/sensor_testing.hpp"

namespace cmap {
namespace pose_spline_test {

std::vector<Eigen::Isometry3d> random_controls(std::size_t n, double turn_rad) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Isometry3d> controls(n, Eigen::Isometry3d::Identity());
  for (std::size_t i = 1; i < n; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    controls[i] = controls[i - 1] * Eigen::AngleAxisd(turn_rad, axis);
    controls[i].translation() += Eigen::Vector3d(normal(random), normal(random), normal(random));
  }
  return controls;
}

/// Body rate from the rotations a little before and after.
Eigen::Vector3d rate_by_difference(const PoseSpline& spline, double t, double h) {
  const Eigen::Matrix3d turn = spline.pose(t - h).linear().transpose() * spline.pose(t + h).linear();
  const Eigen::AngleAxisd a(turn);
  return a.axis() * a.angle() / (2.0 * h);
}

TEST(PoseSpline, DerivativesMatchFiniteDifferences) {
  const PoseSpline spline(100.0, 0.25, random_controls(12, 0.9));
  // Central differences with h = 1e-4 s: rounding 1e-16 * 10 / h^2 = 1e-7; bend h^2 times fourth derivatives (1e3):
  // 1e-5.
  constexpr double kStep = 1e-4, kTolerance = 2e-5;
  for (double t = 100.01; t < spline.end_s() - 0.01; t += 0.0371) {
    const Motion m = spline.motion(t);
    const Eigen::Vector3d before = spline.pose(t - kStep).translation(), after = spline.pose(t + kStep).translation();
    EXPECT_LT((m.velocity_mps - (after - before) / (2 * kStep)).norm(), kTolerance);
    EXPECT_LT((m.acceleration_mps2 - (spline.velocity(t + kStep) - spline.velocity(t - kStep)) / (2 * kStep)).norm(),
              // Acceleration has a bend at the knots, of up to a jerk jump of 1e3 m/s^3 over half a step.
              kTolerance + (std::abs(std::remainder(t - 100.0, 0.25)) < kStep ? 0.1 : 0.0));
    EXPECT_LT((m.angular_rate_radps - rate_by_difference(spline, t, kStep)).norm(), kTolerance);
    const Eigen::Vector3d rate_change =
        (spline.angular_rate_body(t + kStep) - spline.angular_rate_body(t - kStep)) / (2 * kStep);
    EXPECT_LT((m.angular_acceleration_radps2 - rate_change).norm(),
              kTolerance + (std::abs(std::remainder(t - 100.0, 0.25)) < kStep ? 0.1 : 0.0));
    EXPECT_TRUE(m.T_world_body.isApprox(spline.pose(t)));
  }
}

TEST(PoseSpline, IsTwiceContinuousAtTheKnots) {
  const PoseSpline spline(0.0, 0.25, random_controls(12, 0.9));
  for (int knot = 1; knot < 9; ++knot) {
    const double t = 0.25 * knot;
    // Third derivatives reach 1e3: 2e-9 s of them.
    const Motion before = spline.motion(t - 1e-9), after = spline.motion(t + 1e-9);
    EXPECT_LT((before.acceleration_mps2 - after.acceleration_mps2).norm(), 1e-5);
    EXPECT_LT((before.angular_acceleration_radps2 - after.angular_acceleration_radps2).norm(), 1e-5);
    EXPECT_LT((before.angular_rate_radps - after.angular_rate_radps).norm(), 1e-6);
  }
}

TEST(PoseSpline, ConstantMotionByHand) {
  std::vector<Eigen::Isometry3d> controls(8, Eigen::Isometry3d::Identity());
  for (int i = 0; i < 8; ++i) {
    controls[static_cast<std::size_t>(i)].translation() = Eigen::Vector3d(2.0 * (i - 1), 0, 1);
    controls[static_cast<std::size_t>(i)].linear() =
        Eigen::AngleAxisd(0.3 * (i - 1), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
  const PoseSpline spline(5.0, 0.5, controls);
  EXPECT_EQ(spline.end_s(), 7.5);
  const Motion m = spline.motion(6.3);
  EXPECT_TRUE(m.T_world_body.translation().isApprox(Eigen::Vector3d(4.0 * 1.3, 0, 1), 1e-12));
  EXPECT_NEAR(Eigen::AngleAxisd(m.T_world_body.linear()).angle(), 0.6 * 1.3, 1e-12);
  EXPECT_TRUE(m.velocity_mps.isApprox(Eigen::Vector3d(4, 0, 0), 1e-12));
  EXPECT_TRUE(m.angular_rate_radps.isApprox(Eigen::Vector3d(0, 0, 0.6), 1e-12));
  EXPECT_LT(m.acceleration_mps2.norm() + m.angular_acceleration_radps2.norm(), 1e-11);
}

TEST(PoseSpline, RefusesWhatCannotBe) {
  const auto controls = random_controls(6, 0.5);
  EXPECT_THROW(PoseSpline(0, 0.1, random_controls(3, 0.5)), std::invalid_argument);
  EXPECT_THROW(PoseSpline(0, 0.0, controls), std::invalid_argument);
  EXPECT_THROW(PoseSpline(0, 0.1, random_controls(5, 3.1415926)), std::invalid_argument);
  const PoseSpline spline(1.0, 0.1, controls);
  EXPECT_THROW(spline.pose(0.99), std::out_of_range);
  EXPECT_THROW(spline.pose(1.31), std::out_of_range);
  EXPECT_THROW(spline.pose(std::nan("")), std::out_of_range);
  EXPECT_NO_THROW(spline.pose(1.0 + 3 * 0.1));
}

}  // namespace pose_spline_test
}  // namespace cmap
