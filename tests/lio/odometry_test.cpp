#include "cmap/lio/odometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "cmap/core/error.hpp"
#include "lio/simulated_drive.hpp"

namespace cmap {
namespace odometry_test {

using Eigen::Vector3d;
using test::Drive;
using test::Result;

/// 30 m at walking pace: 22 s, made once.
const Drive& walk() {
  static const Drive drive =
      test::drive_through(test::furnished_room(), test::walk_path(1.5, 30.0), test::small_spinning());
  return drive;
}
const Result& walk_with_imu() {
  static const Result result = test::run(walk(), {});
  return result;
}

/// As for what is carried by hand: the defaults are a vehicle's.
OdometryOptions without_imu() {
  OdometryOptions options;
  options.use_imu = false;
  options.free_turn = 0.5;
  options.free_force = 0.8;
  return options;
}

/// The gyro's bias at the end: what it says beyond the truth, averaged over the last two seconds.
Vector3d true_gyro_bias(const Drive& drive) {
  Vector3d sum = Vector3d::Zero();
  int n = 0;
  for (const ImuSample& sample : drive.imu) {
    if (sample.time_s < drive.path.end_s() - 2.0) continue;
    sum += sample.angular_rate_radps - drive.path.angular_rate_body(sample.time_s);
    ++n;
  }
  return sum / n;
}

TEST(Odometry, FollowsAWalkWithAnImu) {
  const Result& result = walk_with_imu();
  EXPECT_EQ(result.scans.size(), walk().scans.size());
  EXPECT_EQ(test::count(result, ScanOutcome::kRegistered), result.scans.size() - 1);
  // 0.3 % of 30 m, and range noise of 1.5 cm at the start.
  EXPECT_LT(test::position_error_m(walk(), result.scans.back()), 0.09);
  EXPECT_LT(test::worst_position_m(walk(), result), 0.09);
  EXPECT_LT(test::worst_attitude_deg(walk(), result), 0.5);
  // White noise of 2.4e-4 rad/s/sqrt(Hz) over 20 s leaves 5e-5; attitudes of 0.01 deg over that time 1e-5.
  EXPECT_LT((result.summary.gyro_bias - true_gyro_bias(walk())).norm(), 3e-4);
  EXPECT_NEAR(result.summary.path_m, 30.0, 2.0) << "of swaying";
  EXPECT_FALSE(result.summary.started_in_motion);
}

/// Without an IMU rates are taken for constant within a scan: of half a degree of sway that is off by 1 mrad.
const Drive& calm_walk() {
  static const Drive drive =
      test::drive_through(test::furnished_room(), test::walk_path(1.5, 20.0, 0.5), test::small_spinning());
  return drive;
}

TEST(Odometry, FollowsAWalkWithoutAnImu) {
  const Result result = test::run(calm_walk(), without_imu());
  EXPECT_EQ(result.scans.size(), calm_walk().scans.size());
  EXPECT_LT(test::position_error_m(calm_walk(), result.scans.back()), 0.1) << "0.5 %";
  EXPECT_LT(test::worst_attitude_deg(calm_walk(), result), 1.0);
}

/// Of the attitude errors' steps: -0.5 where errors are independent, -1 where every second one is off the other way.
double alternation(const Drive& drive, const Result& result) {
  Vector3d last_error = Vector3d::Zero(), last_step = Vector3d::Zero();
  double product = 0.0, square = 0.0;
  for (const OdometryScan& scan : result.scans) {
    const Eigen::Isometry3d T = drive.truth(scan.time_s).inverse() * scan.T_world_imu;
    const Vector3d error = rotation_log(Eigen::Quaterniond(T.linear()));
    const Vector3d step = error - last_error;
    product += step.dot(last_step);
    square += step.squaredNorm();
    last_error = error;
    last_step = step;
  }
  return product / square;
}

TEST(Odometry, PosesDoNotAlternate) {
  // The pose before a scan is kept without an IMU: an error of it must not come back with the other sign, and grow.
  EXPECT_GT(alternation(calm_walk(), test::run(calm_walk(), without_imu())), -0.75);
  EXPECT_GT(alternation(walk(), walk_with_imu()), -0.75);
}

TEST(Odometry, GoesOnFromMotion) {
  // The first scan is of the second 8, in full walk.
  const Drive drive =
      test::drive_through(test::furnished_room(), test::walk_path(1.5, 20.0), test::small_spinning(), 8.0);
  for (const bool with_imu : {true, false}) {
    const Result result = test::run(drive, with_imu ? OdometryOptions{} : without_imu());
    EXPECT_TRUE(result.summary.started_in_motion) << with_imu;
    EXPECT_NEAR(result.summary.start_speed_mps, 1.5, 0.3) << with_imu;
    EXPECT_LT(test::worst_position_m(drive, result), 0.12) << with_imu;
  }
}

/// Distances of the scans' points, as given at the scans' ends, to where they truly were then.
std::vector<double> deskew_errors_m(const Drive& drive, const Result& result) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < result.scans.size(); k += 5) {
    const LidarScan& scan = drive.scans[k];
    const Eigen::Isometry3d T_end_world = drive.truth(result.scans[k].time_s).inverse();
    std::size_t found = 0;
    for (std::size_t i = 0; i < scan.positions.size(); ++i) {
      const float range = scan.positions[i].norm();
      if (range < 1.0F || range > 100.0F) continue;
      const double t = scan.timestamp_s + static_cast<double>(scan.time_s[i]);
      const Vector3d true_point = T_end_world * drive.truth(t) * drive.T_imu_lidar * scan.positions[i].cast<double>();
      errors.push_back((result.scans[k].points.at(found++).cast<double>() - true_point).norm());
    }
    EXPECT_EQ(found, result.scans[k].points.size());
  }
  return errors;
}

TEST(Odometry, StraightensScans) {
  std::vector<double> errors = deskew_errors_m(walk(), walk_with_imu());
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.01) << "the gyro's noise over a tenth of a second is 1 mm at 15 m";
  EXPECT_LT(errors.back(), 0.02);
  errors = deskew_errors_m(calm_walk(), test::run(calm_walk(), without_imu()));
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.05) << "turns at 90 deg/s at corners: 0.2 deg at 15 m";
}

TEST(Odometry, GivesPosesAtTheImusStamps) {
  double before_s = -1.0;
  for (const OdometryScan& scan : walk_with_imu().scans) {
    ASSERT_FALSE(scan.between.empty());
    EXPECT_NEAR(scan.between.back().time_s, scan.time_s, 1e-12);
    EXPECT_LT((scan.between.back().position - scan.T_world_imu.translation()).norm(), 1e-9);
    for (const StampedPose& pose : scan.between) {
      ASSERT_GT(pose.time_s, before_s);
      if (before_s > 0.0) {
        ASSERT_LT(pose.time_s - before_s, 0.0051) << "200 Hz";
      }
      before_s = pose.time_s;
      ASSERT_LT((pose.position - walk().truth(pose.time_s).translation()).norm(), 0.09);
    }
  }
}

TEST(Odometry, IsTheSameTwice) {
  const Result again = test::run(walk(), {});
  ASSERT_EQ(again.scans.size(), walk_with_imu().scans.size());
  for (std::size_t i = 0; i < again.scans.size(); ++i) {
    ASSERT_EQ(again.scans[i].T_world_imu.matrix(), walk_with_imu().scans[i].T_world_imu.matrix()) << i;
    ASSERT_EQ(again.scans[i].n_matches, walk_with_imu().scans[i].n_matches) << i;
  }
}

TEST(Odometry, TheStartMovesAllOfIt) {
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  start.translation() = Vector3d(4.5e5, 5.4e6, 30.0);
  start.linear() = rotation_from({0.1, -0.2, 2.0});
  const Result moved = test::run(walk(), {}, start);
  const Eigen::Isometry3d T = start * walk().truth(0.0).inverse();
  const auto& expected = walk_with_imu().scans.back();
  // Cells begin elsewhere: another map, within the error of either.
  EXPECT_LT((moved.scans.back().T_world_imu.translation() - (T * expected.T_world_imu).translation()).norm(), 0.1);
}

/// Scans as if compensated already: at their stamps, without times.
Drive compensated(const Drive& drive) {
  Drive result = drive;
  for (LidarScan& scan : result.scans) {
    const Eigen::Isometry3d T_lidar_world = (drive.truth(scan.timestamp_s) * drive.T_imu_lidar).inverse();
    for (std::size_t i = 0; i < scan.positions.size(); ++i) {
      const double t = scan.timestamp_s + static_cast<double>(scan.time_s[i]);
      scan.positions[i] =
          (T_lidar_world * drive.truth(t) * drive.T_imu_lidar * scan.positions[i].cast<double>()).cast<float>();
    }
    scan.time_s = {};
  }
  return result;
}

TEST(Odometry, TakesScansWithoutTimes) {
  const Drive drive = compensated(walk());
  const Result result = test::run(drive, {});
  EXPECT_EQ(result.scans[7].time_s, drive.scans[7].timestamp_s) << "the pose is that of the stamp";
  EXPECT_LT(test::worst_position_m(drive, result), 0.09);
  EXPECT_LT(test::worst_attitude_deg(drive, result), 0.5);
}

TEST(Odometry, TakesTimesBeforeTheStamp) {
  Drive drive = walk();
  for (LidarScan& scan : drive.scans) {
    scan.timestamp_s += 0.0625;
    for (float& t : scan.time_s) t -= 0.0625F;
  }
  const Result result = test::run(drive, {}, walk().truth(0.0));
  ASSERT_EQ(result.scans.size(), walk_with_imu().scans.size());
  // Times are floats: 4e-9 s.
  EXPECT_LT(
      (result.scans.back().T_world_imu.translation() - walk_with_imu().scans.back().T_world_imu.translation()).norm(),
      0.01);
}

TEST(Odometry, RefusesOptionsThatMeanNothing) {
  OdometryOptions options;
  options.voxel_m = 0.0;
  EXPECT_THROW(Odometry(options, Eigen::Isometry3d::Identity(), std::nullopt, [](OdometryScan&&) {}), UsageError);
}

}  // namespace odometry_test
}  // namespace cmap
