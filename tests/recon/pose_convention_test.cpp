#include "sessions/pose_convention.hpp"

#include <algorithm>

#include "recon/recon_testing.hpp"

namespace cmap {
namespace pose_convention_test {

using ::testing::HasSubstr;
using ::testing::Not;

/// A camera that looks ahead along a path, and odometry that has it in another world and in meters.
struct Ride {
  std::vector<Eigen::Isometry3d> poses;  ///< camera from a world of the network's, in OpenCV's axes
  OdometryPoses odometry;
};

Eigen::Isometry3d rigid(const Eigen::Vector3d& translation, const Eigen::Matrix3d& rotation) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation;
  T.translation() = translation;
  return T;
}

/// Along an arc that turns by `turn_rad` in all, rising by 2 m; straight ahead where it is 0.
Ride ride(double turn_rad, double sigma_deg = 0.5, double sigma_m = 0.05) {
  constexpr double kLength_m = 20.0, kUnit_m = 3.0;
  std::mt19937_64 random(7);
  const Eigen::Isometry3d T_world_session = rigid({10, -5, 2}, test::random_rotation(random));
  const Eigen::Isometry3d T_file_session = rigid({1, 2, -3}, test::random_rotation(random));
  Ride r;
  for (int i = 0; i < 16; ++i) {
    const double share = i / 15.0, heading = turn_rad * share;
    const double s = turn_rad == 0.0 ? kLength_m * share : kLength_m * std::sin(heading) / turn_rad;
    const double x = turn_rad == 0.0 ? 0.0 : kLength_m * (1.0 - std::cos(heading)) / turn_rad;
    Eigen::Isometry3d T_session_camera = Eigen::Isometry3d::Identity();
    T_session_camera.linear() = rotation_from({0, heading, 0});
    T_session_camera.translation() = Eigen::Vector3d(x, turn_rad == 0.0 ? 0.0 : -2.0 * share, s);
    r.odometry.emplace_back(T_world_session * T_session_camera);
    T_session_camera.linear() = T_session_camera.linear() * test::small_rotation(random, sigma_deg);
    T_session_camera.translation() += test::normal_vector(random, sigma_m);
    T_session_camera.translation() /= kUnit_m;
    r.poses.push_back((T_file_session * T_session_camera).inverse());
  }
  return r;
}

const Eigen::Isometry3d kFlip(Eigen::DiagonalMatrix<double, 3>(1.0, -1.0, -1.0));

std::string doubt(Ride r, Eigen::Isometry3d (*change)(const Eigen::Isometry3d&)) {
  for (Eigen::Isometry3d& pose : r.poses) pose = change(pose);
  return pose_convention_doubt(r.poses, r.odometry, {}).value_or("");
}

Eigen::Isometry3d as_is(const Eigen::Isometry3d& T) { return T; }
Eigen::Isometry3d inverted(const Eigen::Isometry3d& T) { return T.inverse(); }
Eigen::Isometry3d opengl(const Eigen::Isometry3d& T) { return kFlip * T; }
Eigen::Isometry3d opengl_inverted(const Eigen::Isometry3d& T) { return (kFlip * T).inverse(); }

TEST(PoseConvention, RightOnesAreNotDoubted) {
  for (const double turn_rad : {0.0, 0.05, 0.5, 1.5, 3.0}) EXPECT_EQ(doubt(ride(turn_rad), as_is), "") << turn_rad;
}

TEST(PoseConvention, EachWrongOneIsNamedWhereThePathBends) {
  for (const double turn_rad : {0.5, 1.5, 3.0}) {
    EXPECT_THAT(doubt(ride(turn_rad), inverted), HasSubstr("agree with them as camera-to-world"));
    EXPECT_THAT(doubt(ride(turn_rad), opengl), HasSubstr("camera-from-world in OpenGL's axes"));
    EXPECT_THAT(doubt(ride(turn_rad), opengl_inverted), HasSubstr("camera-to-world in OpenGL's axes"));
  }
  EXPECT_THAT(doubt(ride(1.5), inverted), Not(HasSubstr("OpenGL's")));
}

/// Straight ahead from the origin, as VGGT has it, a path turned back may be any of them.
TEST(PoseConvention, AStraightPathLeavesSeveral) {
  Ride r = ride(0.0);
  const Eigen::Isometry3d T_file_first = r.poses.front().inverse();
  for (Eigen::Isometry3d& pose : r.poses) pose = pose * T_file_first;
  EXPECT_THAT(doubt(r, inverted), HasSubstr("as camera-to-world, or as camera-from-world in OpenGL's axes (y up, z "
                                            "backward), or as those of the frames from the last to the first"));
  EXPECT_THAT(doubt(r, opengl), HasSubstr("or as camera-from-world in OpenGL's axes (y up, z backward), or as those of "
                                          "the frames from the last to the first"));
}

TEST(PoseConvention, FramesInReverse) {
  Ride r = ride(1.5);
  std::ranges::reverse(r.poses);
  EXPECT_THAT(doubt(r, as_is), HasSubstr("as those of the frames from the last to the first"));
}

/// A camera that hovers, poses that are missing, noise, a calibration turned by a right angle: no reading fits better.
TEST(PoseConvention, WhatCannotBeToldIsNotDoubted) {
  Ride r = ride(0.0);
  for (auto& pose : r.odometry) pose = r.odometry.front();
  EXPECT_EQ(doubt(r, inverted), "");
  r = ride(0.0);
  for (Eigen::Isometry3d& pose : r.poses) pose.setIdentity();
  EXPECT_EQ(doubt(r, as_is), "");
  r = ride(1.5);
  for (auto& pose : r.odometry) pose = *pose * rigid({0, 0, 0}, rotation_from({0, M_PI_2, 0}));
  EXPECT_EQ(doubt(r, as_is), "");
  for (auto& pose : r.odometry) pose.reset();
  EXPECT_EQ(doubt(r, inverted), "");
  EXPECT_FALSE(pose_convention_doubt({}, {}, {}));
}

TEST(PoseConvention, GapsInOdometryDoNotMatter) {
  Ride r = ride(1.5);
  for (std::size_t i = 3; i < 9; ++i) r.odometry[i].reset();
  EXPECT_EQ(doubt(r, as_is), "");
  EXPECT_THAT(doubt(r, inverted), HasSubstr("camera-to-world"));
}

}  // namespace pose_convention_test
}  // namespace cmap
