#include "cmap/align/pose_pairs.hpp"

#include "align/align_testing.hpp"
#include "align/trajectories.hpp"

namespace cmap {
namespace pose_pairs_test {

using test::curve;
using ::testing::ElementsAre;

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

/// A pose whose x says which it is.
StampedPose pose(double time_s, double x) { return {time_s, {x, 0, 0}, Eigen::Quaterniond::Identity()}; }

std::vector<std::pair<double, double>> names_of(const std::vector<PosePair>& pairs) {
  std::vector<std::pair<double, double>> names;
  for (const PosePair& pair : pairs) names.emplace_back(pair.source.position.x(), pair.target.position.x());
  return names;
}

TEST(PairNearest, TakesTheNearestOfTheLongerForEachOfTheShorter) {
  const Trajectory shorter{pose(1.0, 1), pose(2.0, 2), pose(3.0, 3)};
  const Trajectory longer{pose(0.995, 10), pose(1.004, 11), pose(2.25, 20), pose(2.992, 30)};
  EXPECT_THAT(names_of(pair_nearest(shorter, longer)), ElementsAre(std::pair(1.0, 11.0), std::pair(3.0, 30.0)));
  EXPECT_THAT(names_of(pair_nearest(longer, shorter)), ElementsAre(std::pair(11.0, 1.0), std::pair(30.0, 3.0)));
  EXPECT_EQ(pair_nearest(shorter, longer, 0.3).size(), 3U);
}

TEST(PairNearest, OfTwoAsNearTheEarlierAndOfOneTimeTheLast) {
  const Trajectory one{pose(1.0, 1)};
  EXPECT_THAT(names_of(pair_nearest(one, {pose(0.75, 10), pose(1.25, 11)}, 0.5)), ElementsAre(std::pair(1.0, 10.0)));
  EXPECT_THAT(names_of(pair_nearest(one, {pose(1.0, 10), pose(1.0, 11), pose(9.0, 12)})),
              ElementsAre(std::pair(1.0, 11.0)));
  EXPECT_THAT(names_of(pair_nearest({pose(1.0, 1), pose(1.0, 2)}, {pose(1.0, 10), pose(2.0, 11)})),
              ElementsAre(std::pair(1.0, 10.0), std::pair(2.0, 10.0)))
      << "as many poses: each of the source, repeated ones too";
}

TEST(PairInTime, OfOneTimeTheFirstCounts) {
  EXPECT_THAT(names_of(pair_in_time({pose(1.05, 1), pose(1.05, 2)}, {pose(1.0, 10), pose(1.0, 99), pose(1.1, 20)})),
              ElementsAre(::testing::Pair(1.0, ::testing::DoubleNear(15.0, 1e-9))));
}

TEST(PairInTime, NearestPairsAreInterpolatedOnesWhereTimesAreTheSame) {
  const Trajectory source = curve(0.0, 5.0), target = curve(0.0, 8.0);
  const auto nearest = pair_nearest(source, target), interpolated = pair_in_time(source, target);
  EXPECT_EQ(nearest.size(), source.size());
  EXPECT_EQ(names_of(nearest), names_of(interpolated));
}

}  // namespace pose_pairs_test
}  // namespace cmap
