#include "captures/quaternion_order.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cmap {
namespace quaternion_order_test {

/// A level drive along x, heading half a turn around; force 9.8 up.
Trajectory drive() {
  Trajectory poses;
  for (int i = 0; i <= 10; ++i) {
    const double yaw = 0.1 * i * M_PI;
    poses.push_back({0.1 * i, {1.0 * i, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))});
  }
  return poses;
}

std::vector<ImuSample> level_imu() {
  std::vector<ImuSample> samples;
  for (int i = 0; i <= 100; ++i) samples.push_back({0.01 * i, Eigen::Vector3d::Zero(), {0.1, 0, 9.8}});
  return samples;
}

/// As a reader of x y z w takes rows of w x y z.
Trajectory misread(Trajectory poses) {
  for (StampedPose& pose : poses) {
    const Eigen::Quaterniond q = pose.rotation;
    pose.rotation = Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y());
  }
  return poses;
}

TEST(QuaternionOrder, RightOnesHaveNoFault) { EXPECT_EQ(quaternion_order_fault(drive(), level_imu()), ""); }

TEST(QuaternionOrder, WrongOnesAreNamed) {
  const std::string fault = quaternion_order_fault(misread(drive()), level_imu());
  EXPECT_NE(fault.find("order w x y z"), std::string::npos) << fault;
}

TEST(QuaternionOrder, AWorldThatIsNotUprightIsNoFault) {
  Trajectory poses = drive();
  const Eigen::Quaterniond lying(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX()));
  for (StampedPose& pose : poses) pose.rotation = lying * pose.rotation;
  EXPECT_EQ(quaternion_order_fault(poses, level_imu()), "");
}

TEST(QuaternionOrder, WithoutSamplesNothingIsSaid) { EXPECT_EQ(quaternion_order_fault(misread(drive()), {}), ""); }

}  // namespace quaternion_order_test
}  // namespace cmap
