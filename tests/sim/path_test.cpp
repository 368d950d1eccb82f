#include "cmap/sim/path.hpp"

#include <stdexcept>

#include "cmap/core/error.hpp"
#include "sim/sensor_testing.hpp"

namespace cmap {
namespace path_test {

using ::testing::HasSubstr;

TEST(Path, RestsExactlyThenMovesAtItsSpeed) {
  PathOptions options;
  options.rest_s = 3.0;
  options.speed_mps = 5.0;
  options.sway_position_m = 0.1;
  options.sway_yaw_deg = 2.0;
  options.start_time_s = 1000.0;
  PathOptions steady = options;
  steady.sway_position_m = steady.sway_yaw_deg = 0.0;
  const Route route = straight_route({1, 2, 3}, 90.0, 100.0);
  const PoseSpline path = make_path(route, options, 1), straight = make_path(route, steady, 1);
  EXPECT_EQ(path.start_s(), 1000.0);
  for (double t = 1000.0; t < 1003.0; t += 0.17) {
    EXPECT_TRUE(path.pose(t).isApprox(path.pose(1000.0), 1e-15));
    EXPECT_LT(path.acceleration(t).norm() + path.angular_rate_body(t).norm(), 1e-12);
  }
  EXPECT_TRUE(path.pose(1000.0).translation().isApprox(Eigen::Vector3d(1, 2, 3), 1e-12));
  EXPECT_TRUE(path.pose(1000.0).linear().col(0).isApprox(Eigen::Vector3d(0, 1, 0), 1e-12)) << "x looks along the way";
  // A uniform B-spline reproduces straight motion.
  EXPECT_TRUE(straight.velocity(1010.0).isApprox(Eigen::Vector3d(0, 5, 0), 1e-9));
  EXPECT_TRUE(straight.pose(straight.end_s()).translation().isApprox(Eigen::Vector3d(1, 102, 3), 1e-9));
  EXPECT_GT((path.velocity(1010.0) - Eigen::Vector3d(0, 5, 0)).norm(), 0.01) << "sway";
}

TEST(Path, SwayHasItsStandardDeviation) {
  PathOptions options;
  options.hold_s = 400.0;
  options.sway_position_m = 0.2;
  options.sway_roll_deg = 2.0;
  const PoseSpline path = make_path({{0, 0, 10}}, options, 3);
  std::vector<double> x, roll;
  for (double t = 10.0; t < 400.0; t += 0.05) {
    const Eigen::Isometry3d T = path.pose(t);
    x.push_back(T.translation().x());
    roll.push_back(std::asin(T.linear()(2, 1)) * 180.0 / M_PI);
  }
  // 100 periods of three sines, and the spline's smoothing of 0.1 s knots (sinc^4: 1 - 2 (f dt)^2 ...: 2 % at 0.7 Hz).
  EXPECT_NEAR(testing::rms(x), 0.2, 0.01);
  EXPECT_NEAR(testing::rms(roll), 2.0, 0.1);
}

TEST(Path, RoundsCornersAndFollowsThem) {
  PathOptions options;
  options.speed_mps = 2.0;
  options.corner_m = 2.0;
  const PoseSpline path = make_path(block_route({0, 0}, {40, 30}, 1.0, 5.0), options, 1);
  double furthest = 0.0, turned = 0.0, swiftest = 0.0;
  for (double t = path.start_s(); t < path.end_s(); t += 0.01) {
    const Motion m = path.motion(t);
    furthest = std::max(furthest, m.acceleration_mps2.norm());
    turned += 0.01 * m.angular_rate_radps.z();
    swiftest = std::max(swiftest, m.velocity_mps.norm());
    if (m.velocity_mps.norm() > 1.0) {
      const Eigen::Vector3d forward = m.T_world_body.linear().col(0);
      EXPECT_GT(forward.dot(m.velocity_mps.normalized()), 0.98);
    }
  }
  EXPECT_LT(furthest, 4.0) << "2 m/s around a corner rounded over 4 m: v^2 / r = 4 / 1.4, less at its ends";
  EXPECT_NEAR(turned, 2.0 * M_PI, 0.02) << "counterclockwise, once";
  EXPECT_LT(swiftest, 2.01);
  EXPECT_TRUE(path.pose(path.end_s()).translation().isApprox(Eigen::Vector3d(5, 0, 1), 1e-6)) << "past the start";
}

TEST(Path, SurveyLinesKeepTheirAttitude) {
  PathOptions options;
  options.speed_mps = 8.0;
  options.turn_with_route = false;
  options.heading_offset_deg = 30.0;
  const Route route = survey_route({-100, 0}, {100, 40}, 80.0, 20.0);
  ASSERT_EQ(route.size(), 6u);
  EXPECT_EQ(route[2], Eigen::Vector3d(100, 20, 80));
  EXPECT_EQ(route[5], Eigen::Vector3d(100, 40, 80));
  const PoseSpline path = make_path(route, options, 1);
  for (double t = 0; t < path.end_s(); t += 1.0) {
    EXPECT_TRUE(path.pose(t).linear().isApprox(Eigen::AngleAxisd(M_PI / 6, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                                               1e-12));
    EXPECT_NEAR(path.pose(t).translation().z(), 80.0, 1e-9);
  }
}

TEST(Path, DrapedRoutesFollowTheGround) {
  const Route draped = draped_route(
      {{0, 0, 99}, {10, 0, 99}}, [](double x, double) { return 0.1 * x; }, 1.5, 3.0);
  ASSERT_EQ(draped.size(), 5u);  // 10 m in parts of at most 3 m: 4 parts
  for (const Eigen::Vector3d& p : draped) EXPECT_NEAR(p.z(), 0.1 * p.x() + 1.5, 1e-12);
  EXPECT_EQ(draped[1].x(), 2.5);
}

TEST(Path, ShortRoutesAreSlower) {
  PathOptions options;
  options.ramp_s = 2.0;
  options.speed_mps = 10.0;
  const PoseSpline path = make_path(straight_route({0, 0, 0}, 0.0, 4.0), options, 1);
  double swiftest = 0.0;
  for (double t = 0; t < path.end_s(); t += 0.01) swiftest = std::max(swiftest, path.velocity(t).norm());
  EXPECT_NEAR(swiftest, 2.0, 0.05) << "4 m in two ramps of 2 s";
}

TEST(Path, RefusesOptionsOutOfRange) {
  PathOptions options;
  options.speed_mps = 0.0;
  try {
    make_path({{0, 0, 0}}, options, 1);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("path: speed_mps: 0 must be above 0"));
  }
  options.speed_mps = 1.0;
  options.sway_frequency_hz = 3.0;
  EXPECT_THROW(make_path({{0, 0, 0}}, options, 1), UsageError) << "the knots are too far apart for it";
  options.sway_frequency_hz = 1.0;
  EXPECT_THROW(make_path({}, options, 1), std::invalid_argument);
}

}  // namespace path_test
}  // namespace cmap
