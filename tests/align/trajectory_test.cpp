#include "cmap/align/trajectory.hpp"

#include "align/align_testing.hpp"

namespace cmap {
namespace trajectory_test {

using ::testing::HasSubstr;

/// A climbing curve, ten poses a second.
Trajectory curve(double from_s, double to_s, double step_s = 0.1) {
  Trajectory trajectory;
  for (double t = from_s; t <= to_s; t += step_s) {
    trajectory.push_back({t,
                          {10 * std::cos(0.3 * t), 10 * std::sin(0.3 * t), std::sin(t)},
                          Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * t, Eigen::Vector3d::UnitZ()))});
  }
  return trajectory;
}

Trajectory moved(const Trajectory& trajectory, const Similarity& T) {
  Trajectory result = trajectory;
  for (StampedPose& pose : result) {
    pose.position = T * pose.position;
    pose.rotation = Eigen::Quaterniond(T.rotation) * pose.rotation;
  }
  return result;
}

TEST(PoseAt, InterpolatesByHand) {
  const Trajectory t{{1.0, {0, 0, 0}, Eigen::Quaterniond::Identity()},
                     {1.1, {1, 2, 4}, Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()))},
                     {2.0, {5, 5, 5}, Eigen::Quaterniond::Identity()}};
  const auto quarter = pose_at(t, 1.025);
  ASSERT_TRUE(quarter);
  EXPECT_TRUE(quarter->position.isApprox(Eigen::Vector3d(0.25, 0.5, 1.0), 1e-9)) << "0.025 / 0.1, rounded stamps";
  EXPECT_NEAR(Eigen::AngleAxisd(quarter->rotation).angle(), M_PI / 8, 1e-9);
  EXPECT_FALSE(pose_at(t, 1.5)) << "a gap of 0.9 s";
  EXPECT_TRUE(pose_at(t, 1.5, 1.0));
  EXPECT_TRUE(pose_at(t, 2.0)) << "at a pose, no gap counts";
  EXPECT_FALSE(pose_at(t, 0.9));
  EXPECT_FALSE(pose_at(t, 2.1));
  EXPECT_FALSE(pose_at({}, 1.0));
}

TEST(PoseAt, RotationsTakeTheShortArc) {
  Trajectory t = curve(0.0, 0.1);
  t[1].rotation.coeffs() *= -1.0;  // the same rotation
  EXPECT_NEAR(Eigen::AngleAxisd(pose_at(t, 0.05)->rotation).angle(), 0.015, 1e-12);
}

TEST(AlignTrajectories, RecoversTheTransformBetweenTheWorlds) {
  std::mt19937_64 random(1);
  const Similarity rigid = test::random_similarity(random, 1.0, 1.0, 1000.0);
  const Similarity scaled = test::random_similarity(random, 0.1, 10.0, 1000.0);
  const Trajectory source = curve(0.0, 20.0);
  for (const auto fit : {TrajectoryFit::kFirstFrame, TrajectoryFit::kSe3}) {
    const Alignment found = align_trajectories(source, moved(source, rigid), fit);
    EXPECT_TRUE(found.T_dst_src.isApprox(rigid.matrix(), 1e-11));
    EXPECT_LT(found.rmse_m, 1e-11);
    EXPECT_EQ(found.overlap, 1.0);
  }
  const Alignment found = align_trajectories(source, moved(source, scaled), TrajectoryFit::kSim3);
  EXPECT_TRUE(found.T_dst_src.isApprox(scaled.matrix(), 1e-11));
  EXPECT_NEAR(found.scale, scaled.scale, 1e-11 * scaled.scale);
}

TEST(AlignTrajectories, OtherStampsAndPartialOverlap) {
  std::mt19937_64 random(2);
  const Similarity T = test::random_similarity(random, 1.0, 1.0, 10.0);
  const Trajectory source = curve(0.03, 20.0);
  const Alignment found = align_trajectories(source, moved(curve(10.0, 30.0), T), TrajectoryFit::kSe3);
  // Chords of 0.1 s on a path of radius 10 m and acceleration 1 m/s^2: off by at most 1 (0.1)^2 / 8 = 1.3 mm.
  EXPECT_LT(found.rmse_m, 2e-3);
  EXPECT_NEAR(found.overlap, 0.5, 0.01);
  EXPECT_LT(test::angle_between_deg(similarity_from(found.T_dst_src), T), 0.02);
}

TEST(AlignTrajectories, RefusesWhatCannotBe) {
  const Trajectory early = curve(0.0, 5.0), late = curve(100.0, 105.0);
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { align_trajectories(early, late, TrajectoryFit::kSe3); }),
              HasSubstr("the times do not meet: the source is from 0 to"));
  Trajectory nanoseconds = late;
  for (StampedPose& pose : nanoseconds) pose.time_s *= 1e9;
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { align_trajectories(nanoseconds, early, TrajectoryFit::kSe3); }),
              HasSubstr("are those of the source nanoseconds?"));
  Trajectory straight = early;
  for (StampedPose& pose : straight) pose.position = {0, pose.time_s, 0};
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { align_trajectories(straight, straight, TrajectoryFit::kSe3); }),
              HasSubstr("the rotation about (0.00, 1.00, 0.00)"));
  EXPECT_NO_THROW(align_trajectories(straight, straight, TrajectoryFit::kFirstFrame));
  Trajectory hovering = early;
  for (StampedPose& pose : hovering) pose.position = {1, 2, 3};
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { align_trajectories(hovering, early, TrajectoryFit::kSim3); }),
              HasSubstr("coincide"));
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { align_trajectories({}, early, TrajectoryFit::kSe3); }),
              HasSubstr("without poses"));
}

TEST(AlignTrajectories, NearlyStraightPathsAreFlagged) {
  Trajectory source = curve(0.0, 10.0);
  for (StampedPose& pose : source) pose.position = {0.01 * std::sin(pose.time_s), 10.0 * pose.time_s, 0};
  const Alignment found = align_trajectories(source, source, TrajectoryFit::kSe3);
  EXPECT_EQ(found.weakest, "rotation about (0.00, 1.00, 0.00)");
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_THAT(found.warnings[0], HasSubstr("weakly determined"));
}

}  // namespace trajectory_test
}  // namespace cmap
