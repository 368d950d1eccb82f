// What recordings do to odometry: gaps, disorder, jumps, views of nothing and of too little.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "cmap/lio/odometry.hpp"
#include "lio/simulated_drive.hpp"

namespace cmap {
namespace odometry_input_test {

using Eigen::Vector3d;
using test::Drive;
using test::Result;

/// 8 m in the room, some 8 s.
const Drive& walk() {
  static const Drive drive =
      test::drive_through(test::furnished_room(), test::walk_path(1.5, 8.0), test::small_spinning());
  return drive;
}
/// The same with little sway, for what rates are guessed of.
const Drive& calm_walk() {
  static const Drive drive =
      test::drive_through(test::furnished_room(), test::walk_path(1.5, 8.0, 0.3), test::small_spinning());
  return drive;
}
/// Range noise of 1.5 cm on a thousand points, and 0.3 % of the way.
constexpr double kClose_m = 0.06;

std::size_t n_expected() { return walk().scans.size(); }

TEST(OdometryInput, SamplesTwiceAndLateAreLeftOutAndCounted) {
  Drive drive = walk();
  std::vector<ImuSample> samples;
  for (std::size_t i = 0; i < drive.imu.size(); ++i) {
    samples.push_back(drive.imu[i]);
    if (i % 100 == 50) samples.push_back(drive.imu[i]);
    if (i % 100 == 70) samples.push_back(drive.imu[i - 20]);
  }
  const std::size_t n_extra = samples.size() - drive.imu.size();
  drive.imu = samples;
  const Result result = test::run(drive, {}), plain = test::run(walk(), {});
  EXPECT_EQ(result.summary.n_late_samples, n_extra);
  ASSERT_EQ(result.scans.size(), plain.scans.size());
  EXPECT_EQ(result.scans.back().T_world_imu.matrix(), plain.scans.back().T_world_imu.matrix()) << "to the bit";
}

TEST(OdometryInput, ScansTwiceAndLateAreLeftOutAndCounted) {
  Drive drive = walk();
  drive.scans.insert(drive.scans.begin() + 31, drive.scans[30]);
  drive.scans.insert(drive.scans.begin() + 41, drive.scans[20]);
  const Result result = test::run(drive, {}), plain = test::run(walk(), {});
  EXPECT_EQ(result.summary.n_late_scans, 2U);
  ASSERT_EQ(result.scans.size(), plain.scans.size());
  EXPECT_EQ(result.scans.back().T_world_imu.matrix(), plain.scans.back().T_world_imu.matrix());
}

TEST(OdometryInput, TimeThatGoesBackKeepsTheTrajectorySoFar) {
  Drive drive = walk();
  for (std::size_t i = 40; i < drive.scans.size(); ++i) drive.scans[i].timestamp_s -= 100.0;
  const Result result = test::run(drive, {});
  EXPECT_EQ(result.scans.size(), 40U);
  EXPECT_EQ(result.summary.n_late_scans, drive.scans.size() - 40);
  EXPECT_LT(test::worst_position_m(drive, result), kClose_m);
}

TEST(OdometryInput, ScansBeforeTheImuAreLeftOutAndCounted) {
  Drive drive = walk();
  std::erase_if(drive.imu, [](const ImuSample& sample) { return sample.time_s < 2.0; });
  const Result result = test::run(drive, {}, drive.truth(2.0));
  EXPECT_EQ(result.summary.n_before_imu, 20U);
  EXPECT_EQ(result.scans.size(), n_expected() - 20);
  EXPECT_LT(test::worst_position_m(drive, result), kClose_m);
}

TEST(OdometryInput, AGapOfTheImuIsGuessedOver) {
  Drive drive = walk();
  std::erase_if(drive.imu, [](const ImuSample& sample) { return sample.time_s > 4.0 && sample.time_s < 4.5; });
  const Result result = test::run(drive, {});
  EXPECT_EQ(result.summary.n_imu_gaps, 1U);
  EXPECT_EQ(result.scans.size(), n_expected());
  EXPECT_LT(test::position_error_m(drive, result.scans.back()), kClose_m);
  EXPECT_LT(test::attitude_error_deg(drive, result.scans.back()), 0.5);
}

TEST(OdometryInput, AnImuThatEndsEarlyIsGuessedOn) {
  Drive drive = walk();
  std::erase_if(drive.imu, [](const ImuSample& sample) { return sample.time_s > 6.0; });
  const Result result = test::run(drive, {});
  EXPECT_EQ(result.scans.size(), n_expected()) << "scans after it too";
  EXPECT_LT(test::position_error_m(drive, result.scans.back()), 0.15);
}

TEST(OdometryInput, WithoutAnyScanNothingIsGiven) {
  Drive drive = walk();
  drive.scans.clear();
  std::size_t n = 0;
  Odometry odometry({}, drive.T_imu_lidar, std::nullopt, [&](OdometryScan&&) { ++n; });
  for (const ImuSample& sample : drive.imu) odometry.add(sample);
  odometry.finish();
  EXPECT_EQ(n, 0U);
  EXPECT_EQ(odometry.summary().n_scans, 0U);
}

TEST(OdometryInput, OfOneScanThePoseIsTheStart) {
  Drive drive = walk();
  drive.scans.resize(1);
  const Result result = test::run(drive, {});
  ASSERT_EQ(result.scans.size(), 1U);
  EXPECT_EQ(result.scans[0].outcome, ScanOutcome::kFirst);
  EXPECT_LT(test::position_error_m(drive, result.scans[0]), 1e-9) << "it rests";
}

TEST(OdometryInput, EmptyScansArePredicted) {
  for (const bool with_imu : {true, false}) {
    Drive drive = with_imu ? walk() : calm_walk();
    for (std::size_t i : {30U, 31U, 32U, 50U}) {
      drive.scans[i].positions = {};
      drive.scans[i].time_s = {};
      drive.scans[i].intensity = {};
      drive.scans[i].ring = {};
      drive.scans[i].timestamp_s += 0.0999;  // an empty scan's end
    }
    OdometryOptions options;
    options.use_imu = with_imu;
    options.free_turn = 0.5;  // of a hand
    options.free_force = 0.8;
    const Result result = test::run(drive, options);
    ASSERT_EQ(result.scans.size(), drive.scans.size());
    EXPECT_EQ(test::count(result, ScanOutcome::kPredicted), 4U) << with_imu;
    EXPECT_EQ(result.scans[31].outcome, ScanOutcome::kPredicted);
    EXPECT_EQ(result.scans[31].n_points, 0U);
    EXPECT_LT(test::position_error_m(drive, result.scans[31]), with_imu ? kClose_m : 0.2) << with_imu;
    EXPECT_LT(test::position_error_m(drive, result.scans.back()), with_imu ? kClose_m : 0.12) << with_imu;
  }
}

TEST(OdometryInput, AllPointsBlindArePredicted) {
  Drive drive = walk();
  for (std::size_t i = 40; i < 45; ++i) {
    for (auto& p : drive.scans[i].positions) p *= 0.5F / p.norm();
  }
  const Result result = test::run(drive, {});
  EXPECT_EQ(test::count(result, ScanOutcome::kPredicted), 5U);
  EXPECT_EQ(result.scans[42].n_points, 0U);
  EXPECT_GT(result.scans[42].n_measured, 1000U) << "and it shows";
  EXPECT_GT(result.scans[44].position_error_m, result.scans[39].position_error_m) << "as uncertain as it is";
  EXPECT_LT(test::position_error_m(drive, result.scans.back()), kClose_m);
}

TEST(OdometryInput, PointsThatAreNoneAreLeftOut) {
  Drive drive = walk();
  for (LidarScan& scan : drive.scans) {
    for (std::size_t i = 0; i < scan.positions.size(); i += 7) {
      scan.positions[i] = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
    }
  }
  const Result result = test::run(drive, {});
  EXPECT_EQ(test::count(result, ScanOutcome::kRegistered), n_expected() - 1);
  EXPECT_LT(test::worst_position_m(drive, result), kClose_m);
}

/// The first half of the walk in the room, the rest in a street of a town: the sensor was carried off unseen.
TEST(OdometryInput, AJumpIsReportedAndOdometryGoesOn) {
  const Scene town = make_town({});
  std::vector<Eigen::Isometry3d> controls;
  for (int i = -1; i < 100; ++i) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Vector3d(-30.0 + 0.15 * std::max(0, i), 100.0, 1.8);
    controls.push_back(T);
  }
  const Drive street = test::drive_through(town, PoseSpline(0.0, 0.1, controls), test::small_spinning(), 4.0);
  Drive drive = walk();
  drive.scans.resize(40);
  for (const LidarScan& scan : street.scans) drive.scans.push_back(scan);
  std::erase_if(drive.imu, [](const ImuSample& sample) { return sample.time_s > 4.0; });
  for (const ImuSample& sample : street.imu) {
    if (sample.time_s > 4.0) drive.imu.push_back(sample);
  }
  const Result result = test::run(drive, {});
  ASSERT_EQ(result.scans.size(), drive.scans.size());
  EXPECT_GE(test::count(result, ScanOutcome::kPredicted), 1U);
  EXPECT_GE(test::count(result, ScanOutcome::kNewMap), 1U);
  EXPECT_EQ(result.scans.back().outcome, ScanOutcome::kRegistered) << "onto the new map";
  const OdometryScan &from = result.scans[result.scans.size() - 21], &to = result.scans.back();
  const double moved_m = (to.T_world_imu.translation() - from.T_world_imu.translation()).norm();
  EXPECT_NEAR(moved_m, 3.0, 0.15) << "1.5 m/s there again";
}

TEST(OdometryInput, OneWallLeavesDirectionsOpenAndSaysSo) {
  PathOptions path;
  path.rest_s = 1.0;
  path.speed_mps = 1.0;
  Drive drive = test::drive_through(test::one_wall(), make_path(straight_route({0, 0, 0}, 0.0, 3.0), path, 1),
                                    test::small_spinning());
  const Result result = test::run(drive, {});
  ASSERT_GT(result.scans.size(), 30U);
  for (std::size_t i = 1; i < result.scans.size(); ++i) {
    const OdometryScan& scan = result.scans[i];
    ASSERT_EQ(scan.outcome, ScanOutcome::kRegistered) << i;
    ASSERT_EQ(scan.open_shifts_world.size(), 2U) << i;
    ASSERT_EQ(scan.open_turns_imu.size(), 1U) << i;
    for (const Vector3d& shift : scan.open_shifts_world) EXPECT_LT(std::abs(shift.y()), 0.05) << i;
  }
  const Vector3d error =
      result.scans.back().T_world_imu.translation() - drive.truth(result.scans.back().time_s).translation();
  EXPECT_LT(std::abs(error.y()), 0.02) << "held by the wall";
  // Along it the IMU alone: an accelerometer off by 0.03 m/s^2 for 5 s is 0.4 m, and gravity is known to 0.05.
  EXPECT_LT(error.norm(), 1.0);
  EXPECT_LT(error.norm(), 2.0 * result.scans.back().position_error_m) << "and known to be that uncertain";
}

/// A sensor that stands for ten minutes: fifty scans of 16 lines of 180, over and over, and an IMU whose biases walk.
Drive standing() {
  std::vector<Eigen::Isometry3d> controls(6060, Eigen::Isometry3d::Identity());
  LidarOptions lidar = test::small_spinning();
  lidar.azimuth_steps = 180;
  Drive drive{.path = PoseSpline(0.0, 0.1, controls), .imu_options = {}, .imu = {}, .scans = {}};
  drive.imu_options.rate_hz = 100.0;
  drive.imu = simulate_imu(drive.path, drive.imu_options, 3);
  const Scene room = test::furnished_room();
  std::vector<LidarScan> seen;
  for (int i = 0; i < 50; ++i) {
    seen.push_back(simulate_scan(room, drive.path, drive.T_imu_lidar, lidar, 0.1 * i, 5));
  }
  for (std::size_t i = 0; i < 6000; ++i) {
    drive.scans.push_back(seen[i % seen.size()]);
    drive.scans.back().timestamp_s = 0.1 * static_cast<double>(i);
  }
  return drive;
}

TEST(OdometryInput, TenMinutesOfStandingDoNotDrift) {
  const Drive drive = standing();
  for (const bool with_imu : {true, false}) {
    OdometryOptions options;
    options.use_imu = with_imu;
    const Result result = test::run(drive, options);
    ASSERT_EQ(result.scans.size(), 6000U);
    EXPECT_GT(test::count(result, ScanOutcome::kRegistered), 5900U);
    // A scan of 2800 points, noise 1.5 cm, places itself to some millimeters; the map is that of the first ones.
    EXPECT_LT(test::worst_position_m(drive, result), 0.02) << with_imu;
    EXPECT_LT(test::worst_attitude_deg(drive, result), 0.2) << with_imu;
    Vector3d first = Vector3d::Zero(), last = Vector3d::Zero();
    for (std::size_t i = 0; i < 500; ++i) {
      first += result.scans[100 + i].T_world_imu.translation() / 500.0;
      last += result.scans[5500 + i].T_world_imu.translation() / 500.0;
    }
    EXPECT_LT((last - first).norm(), 0.003) << "ten times the same fifty scans: their noise averages out " << with_imu;
  }
}

}  // namespace odometry_input_test
}  // namespace cmap
