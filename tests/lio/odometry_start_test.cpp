#include <gtest/gtest.h>

#include "lio/simulated_drive.hpp"
#include "odometry/start.hpp"

namespace cmap {
namespace odometry_start_test {

using Eigen::Vector3d;
using test::Drive;

/// Along x at a steady speed through a street of the town, turning a little.
PoseSpline street(double speed_mps, double turn_radps) {
  std::vector<Eigen::Isometry3d> controls;
  for (int i = -1; i < 12; ++i) {
    const double t = 0.1 * i, heading = turn_radps * t;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Vector3d(-10.0 + speed_mps * t, 38.5, 1.8);
    T.linear() = rotation_from({0.0, 0.0, heading});
    controls.push_back(T);
  }
  return PoseSpline(0.0, 0.1, controls);
}

struct Found {
  Start start;
  Motion truth;  ///< at the first scan's end
};

Found start_of(double speed_mps, double turn_radps, bool with_imu) {
  static const Scene town = make_town({});
  const Drive drive = test::drive_through(town, street(speed_mps, turn_radps), lidar_model("spinning_16"), 0.0, 2);
  const OdometryOptions options;
  const ScanPoints first = scan_points(drive.scans[0], options), second = scan_points(drive.scans[1], options);
  const std::span<const ImuSample> imu = with_imu ? std::span(drive.imu).first(41) : std::span<const ImuSample>();
  return {find_start(first, second, imu, drive.T_imu_lidar, drive.truth(0.0), options), drive.path.motion(first.end_s)};
}

void expect_found(const Found& found, double position_m, double velocity_mps) {
  EXPECT_TRUE(found.start.in_motion);
  EXPECT_LT((found.start.state.velocity - found.truth.velocity_mps).norm(), velocity_mps);
  EXPECT_LT((found.start.state.position - found.truth.T_world_body.translation()).norm(), position_m);
  EXPECT_LT(
      rotation_angle_rad(found.truth.T_world_body.linear().transpose() * found.start.state.rotation.toRotationMatrix()),
      0.2 * M_PI / 180.0);
}

// Two scans register to 1 or 2 cm: 0.2 m/s of what happens in a tenth of a second.
TEST(OdometryStart, FindsTenMetersASecond) {
  expect_found(start_of(10.0, 0.0, true), 0.03, 0.25);
  expect_found(start_of(10.0, 0.0, false), 0.03, 0.25);
}

TEST(OdometryStart, FindsItInATurn) {
  const Found found = start_of(8.0, 0.3, false);
  expect_found(found, 0.03, 0.3);
  EXPECT_NEAR(found.start.state.gyro_bias.z(), -0.3, 0.02) << "without an IMU in place of the rate, within a degree";
}

TEST(OdometryStart, OfAStandingSensorIsAtRest) {
  for (const bool with_imu : {true, false}) {
    const Found found = start_of(0.0, 0.0, with_imu);
    EXPECT_FALSE(found.start.in_motion);
    EXPECT_EQ(found.start.state.velocity, Vector3d(Vector3d::Zero()));
    EXPECT_LT((found.start.state.position - found.truth.T_world_body.translation()).norm(), 1e-12);
  }
}

TEST(OdometryStart, AtRestTheImuGivesGravityAndBias) {
  std::vector<ImuSample> imu;
  const Vector3d bias(0.01, -0.02, 0.005), tilted = rotation_from({0.1, -0.2, 0.0}).transpose() * Vector3d(0, 0, 9.7);
  for (int i = 0; i < 100; ++i) imu.push_back({0.01 * i, bias, tilted});
  ScanPoints first;
  first.end_s = 1.0;
  const Start start = start_at_rest(first, imu, std::nullopt);
  EXPECT_LT((start.state.gyro_bias - bias).norm(), 1e-12);
  const Vector3d up = start.state.rotation * tilted.normalized();
  EXPECT_LT((up - Vector3d::UnitZ()).norm(), 1e-12) << "upright by gravity";
  const Vector3d ahead = start.state.rotation * Vector3d::UnitX();
  EXPECT_NEAR(ahead.y(), 0.0, 1e-12) << "heading along x";
  EXPECT_GT(ahead.x(), 0.9);
  EXPECT_NEAR(start.state.gravity.norm(), 9.80665, 1e-9) << "whatever the unit: in g too";
  EXPECT_LT(start.state.gravity.z(), -9.8);
}

TEST(OdometryStart, AGivenPoseIsKeptAndGravityFollows) {
  std::vector<ImuSample> imu;
  for (int i = 0; i < 100; ++i) imu.push_back({0.01 * i, Vector3d::Zero(), Vector3d(0, 0, 9.81)});
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Vector3d(4.5e5, 5.4e6, 100.0);
  T.linear() = rotation_from({0.3, 0.1, 2.0});
  ScanPoints first;
  first.end_s = 1.0;
  const Start start = start_at_rest(first, imu, T);
  EXPECT_EQ(start.state.position, T.translation());
  EXPECT_LT((start.state.rotation.toRotationMatrix() - T.linear()).norm(), 1e-12);
  EXPECT_LT((start.state.gravity + 9.80665 * T.linear().col(2)).norm(), 1e-9);
}

}  // namespace odometry_start_test
}  // namespace cmap
