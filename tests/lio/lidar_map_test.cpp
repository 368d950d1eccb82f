#include "cmap/lio/lidar_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cmap {
namespace lidar_map_test {

/// 10 m/s along x, turning 90 degrees a second about z, from t = 0 to 2 s.
Trajectory turning_drive() {
  Trajectory trajectory;
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.1 * i;
    trajectory.push_back(
        {t, {10 * t, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2 * t, Eigen::Vector3d::UnitZ()))});
  }
  return trajectory;
}

/// A wall point seen at four times of the turn lands where it is.
TEST(LidarMap, PointsMoveToTheirOwnTime) {
  const Eigen::Vector3d point(12, 7, 3);
  Eigen::Isometry3d T_imu_lidar = Eigen::Isometry3d::Identity();
  T_imu_lidar.translation() << 0.2, -0.1, 0.5;
  T_imu_lidar.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  LidarScan scan;
  scan.timestamp_s = 0.5;
  for (const float dt : {0.0f, 0.02f, 0.05f, 0.09f}) {
    const double t = 0.5 + static_cast<double>(dt);
    Eigen::Isometry3d T_world_imu = Eigen::Isometry3d::Identity();
    T_world_imu.linear() = Eigen::AngleAxisd(M_PI / 2 * t, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T_world_imu.translation() << 10 * t, 0, 0;
    scan.positions.push_back(((T_world_imu * T_imu_lidar).inverse() * point).cast<float>());
    scan.time_s.push_back(dt);
  }
  PointCloud cloud;
  add_deskewed(scan, turning_drive(), T_imu_lidar, {}, 0.15, cloud);
  ASSERT_EQ(cloud.size(), 4u);
  // Floats of 15 m hold 1e-6; times as floats 1e-9 s, 1e-8 m at 10 m/s.
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((cloud.world(i) - point).norm(), 1e-5);
}

TEST(LidarMap, ScansWithoutTimesAreCompensatedAlready) {
  LidarScan scan;
  scan.timestamp_s = 1.0;
  scan.positions = {{1, 0, 0}, {0, 1, 0}};
  PointCloud cloud;
  add_deskewed(scan, turning_drive(), Eigen::Isometry3d::Identity(), {}, 0.15, cloud);
  // At 1 s: 10 m along x, turned by 90 degrees.
  EXPECT_LT((cloud.world(0) - Eigen::Vector3d(10, 1, 0)).norm(), 1e-5);
  EXPECT_LT((cloud.world(1) - Eigen::Vector3d(9, 0, 0)).norm(), 1e-5);
}

TEST(LidarMap, PointsWithoutAPoseOrOfTheCarrierAreLeftOut) {
  LidarScan scan;
  scan.timestamp_s = 1.95;
  scan.positions = {{5, 0, 0}, {5, 0, 0}, {0.2f, 0, 0}};
  scan.time_s = {0.0f, 0.1f, 0.0f};  // the second after the last pose, the third nearer than half a meter
  PointCloud cloud;
  add_deskewed(scan, turning_drive(), Eigen::Isometry3d::Identity(), {}, 0.15, cloud);
  EXPECT_EQ(cloud.size(), 1u);
}

}  // namespace lidar_map_test
}  // namespace cmap
