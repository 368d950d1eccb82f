#include "loops/loop_proposals.hpp"

#include <gtest/gtest.h>

#include "loops/drift_bound.hpp"

namespace cmap {
namespace {

/// Out along x and back beside it, a keyframe a meter: keyframe k and 2 n - 1 - k are `aside_m` apart.
struct OutAndBack {
  explicit OutAndBack(double aside_m, std::size_t n = 100) {
    for (std::size_t k = 0; k < 2 * n; ++k) {
      Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
      T.translation() << static_cast<double>(k < n ? k : 2 * n - 1 - k), k < n ? 0.0 : aside_m, 0.0;
      poses.push_back(T);
      keyframes.push_back({static_cast<double>(k), T, {Eigen::Vector3f::Zero()}});
    }
    options.submap_spacing_m = 1.0;
    options.min_path_m = 40.0;
    options.revisit_m = 2.0;
    options.drift_m = 0.0;
    options.drift_share = 0.0;
    options.pose_candidates = 1;
    paths_m = path_lengths_m(keyframes);
    submaps = submaps_of(keyframes, paths_m, options);
  }
  LoopOptions options;
  std::vector<Keyframe> keyframes;
  std::vector<Eigen::Isometry3d> poses;
  std::vector<double> paths_m;
  std::vector<Submap> submaps;
};

TEST(Submaps, CoverTheirStretchOfThePath) {
  OutAndBack way(5.0);
  way.options.submap_spacing_m = 10.0;
  way.options.submap_m = 30.0;
  const std::vector<Submap> submaps = submaps_of(way.keyframes, way.paths_m, way.options);
  ASSERT_EQ(submaps.size(), 20U);  // 99 m out, 5 across, which no keyframe halves, 99 back
  EXPECT_EQ(submaps[3].center, 30U);
  EXPECT_EQ(submaps[3].first, 15U);
  EXPECT_EQ(submaps[3].last, 45U);
  EXPECT_EQ(submaps[0].first, 0U);
}

TEST(Submaps, StandingStillMakesOne) {
  OutAndBack way(5.0, 10);
  for (Keyframe& keyframe : way.keyframes) keyframe.T_world_body.setIdentity();
  EXPECT_EQ(submaps_of(way.keyframes, path_lengths_m(way.keyframes), way.options).size(), 1U);
}

TEST(Submaps, ThoseWithoutPointsAreLeftOut) {
  OutAndBack way(5.0, 10);
  for (Keyframe& keyframe : way.keyframes) keyframe.points_body.clear();
  EXPECT_TRUE(submaps_of(way.keyframes, way.paths_m, way.options).empty());
}

TEST(PoseProposals, AreTheNearestOfTheWayOut) {
  OutAndBack way(1.5);
  way.options.revisit_m = 1.7;
  const std::vector<LoopProposal> proposals = pose_proposals(way.submaps, way.poses, way.options);
  ASSERT_FALSE(proposals.empty());
  for (const LoopProposal& p : proposals) {
    const std::size_t from = way.submaps[p.from].center, to = way.submaps[p.to].center;
    EXPECT_EQ(from + to, 199U);
    EXPECT_GE(way.paths_m[to] - way.paths_m[from], 40.0);
  }
  EXPECT_EQ(proposals.size(), 80U);  // the last 20 m out and the first 20 m back are neighbors
}

TEST(PoseProposals, NoneWhereOdometryCannotBeThatWrong) {
  const OutAndBack way(5.0);
  EXPECT_TRUE(pose_proposals(way.submaps, way.poses, way.options).empty());
}

TEST(PoseProposals, MoreWhereOdometryDrifts) {
  OutAndBack way(5.0);
  way.options.drift_share = 0.03;  // 3 m after 100 m of path
  const std::vector<LoopProposal> proposals = pose_proposals(way.submaps, way.poses, way.options);
  ASSERT_FALSE(proposals.empty());
  for (const LoopProposal& p : proposals) EXPECT_GE(way.submaps[p.to].path_m - way.submaps[p.from].path_m, 100.0);
  EXPECT_TRUE(pose_proposals(way.submaps, way.poses, way.options, false).empty());
}

TEST(PoseProposals, SeveralAreNoNeighborsOfEachOther) {
  OutAndBack way(1.5);
  way.options.revisit_m = 30.0;
  way.options.pose_candidates = 3;
  way.options.submap_m = 20.0;
  const std::vector<LoopProposal> proposals = pose_proposals(way.submaps, way.poses, way.options);
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (proposals[i].to != proposals[k].to) continue;
      EXPECT_GE(std::abs(way.submaps[proposals[i].from].path_m - way.submaps[proposals[k].from].path_m), 10.0);
    }
  }
}

TEST(Proposals, RepeatsGoAndTheFirstStays) {
  const std::vector<LoopProposal> left =
      without_repeats({{1, 9, LoopSource::kPose}, {0, 5, LoopSource::kPose}, {1, 9, LoopSource::kDescriptor}, {0, 9}});
  ASSERT_EQ(left.size(), 3U);
  EXPECT_EQ(left[0].to, 5U);
  EXPECT_EQ(left[1].from, 0U);
  EXPECT_EQ(left[2].source, LoopSource::kPose);
}

TEST(DriftBound, GrowsWithThePathUpToALimit) {
  LoopOptions options;
  options.drift_m = 2.0;
  options.drift_share = 0.01;
  options.max_drift_m = 50.0;
  EXPECT_DOUBLE_EQ(drift_bound(0.0, options).m, 2.0);
  EXPECT_DOUBLE_EQ(drift_bound(1000.0, options).m, 12.0);
  EXPECT_DOUBLE_EQ(drift_bound(1e5, options).m, 50.0);
  EXPECT_LE(drift_bound(1e6, options).rad, options.max_drift_deg * 0.0175);
}

}  // namespace
}  // namespace cmap
