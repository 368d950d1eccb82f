#include "cmap/recon/camera_poses.hpp"

#include "recon/recon_testing.hpp"

namespace cmap {
namespace camera_poses_test {

/// 10 m/s along x, turning by 90 degrees about z in a second; 10 Hz, a hole from 1 to 2 s.
Trajectory drive() {
  Trajectory trajectory;
  for (int i = 0; i <= 30; ++i) {
    if (i > 10 && i < 20) continue;
    const double t = 0.1 * i;
    trajectory.push_back({t, {10 * t, 0, 0}, Eigen::Quaterniond(rotation_from({0, 0, t * M_PI_2}))});
  }
  return trajectory;
}

CameraMount mount() {
  CameraMount mount;
  mount.T_imu_lidar.translation() << 0, 0, 1;
  mount.T_lidar_camera.linear() = rotation_from({0, M_PI_2, 0});
  mount.T_lidar_camera.translation() << 2, 0, 0;
  return mount;
}

TEST(CameraPoses, InterpolatedByHand) {
  const std::vector<double> times{0.25, 1.0};
  const auto poses = camera_poses(drive(), mount(), times, PosePairing::kInterpolated);
  ASSERT_TRUE(poses[0] && poses[1]);
  // At 0.25 s the body is at 2.5 m, turned by 22.5 degrees; the camera sits 2 m ahead and 1 m above.
  const double turn = M_PI_2 / 4;
  EXPECT_TRUE(
      poses[0]->translation().isApprox(Eigen::Vector3d(2.5 + 2 * std::cos(turn), 2 * std::sin(turn), 1.0), 1e-12));
  // The camera's z axis is the body's x axis.
  EXPECT_TRUE((poses[0]->linear() * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d(std::cos(turn), std::sin(turn), 0), 1e-12));
  EXPECT_TRUE(poses[1]->translation().isApprox(Eigen::Vector3d(10, 2, 1), 1e-12));
}

TEST(CameraPoses, NearestIsAPoseOfTheTrajectory) {
  const std::vector<double> times{0.26, 0.24, -0.05, 3.1, -1.0, 3.2};
  const auto poses = camera_poses(drive(), CameraMount{}, times, PosePairing::kNearest);
  EXPECT_NEAR(poses[0]->translation().x(), 3.0, 1e-12);
  EXPECT_NEAR(poses[1]->translation().x(), 2.0, 1e-12);
  EXPECT_NEAR(poses[2]->translation().x(), 0.0, 1e-12) << "before the first pose";
  EXPECT_NEAR(poses[3]->translation().x(), 30.0, 1e-12) << "after the last";
  EXPECT_FALSE(poses[4]);
  EXPECT_FALSE(poses[5]);
  EXPECT_FALSE(camera_poses({}, CameraMount{}, times, PosePairing::kNearest)[0]);
}

TEST(CameraPoses, NoneAcrossAHole) {
  const std::vector<double> times{1.05, 1.5, -0.05, 3.05};
  for (const auto& pose : camera_poses(drive(), CameraMount{}, times, PosePairing::kInterpolated)) EXPECT_FALSE(pose);
  EXPECT_TRUE(camera_poses(drive(), CameraMount{}, times, PosePairing::kInterpolated, 1.5)[1]);
}

}  // namespace camera_poses_test
}  // namespace cmap
