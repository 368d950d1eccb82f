#include "cmap/align/trajectory.hpp"

#include <nlohmann/json.hpp>

#include "align/align_testing.hpp"
#include "align/trajectories.hpp"
#include "cmap/align/trajectory_text.hpp"

namespace cmap {
namespace trajectory_test {

using test::along;
using test::curve;
using test::moved;
using test::noisy;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TrajectoryAlignment aligned(const Trajectory& source, const Trajectory& target, TrajectoryFit fit) {
  TrajectoryOptions options;
  options.fit = fit;
  return align_trajectories(source, target, options);
}

TEST(AlignTrajectories, RecoversTheTransformBetweenTheWorlds) {
  std::mt19937_64 random(1);
  const Similarity rigid = test::random_similarity(random, 1.0, 1.0, 1000.0);
  const Similarity scaled = test::random_similarity(random, 0.1, 10.0, 1000.0);
  const Trajectory source = curve(0.0, 20.0);
  for (const auto fit : {TrajectoryFit::kFirstFrame, TrajectoryFit::kSe3}) {
    const Alignment found = aligned(source, moved(source, rigid), fit);
    EXPECT_TRUE(found.T_dst_src.isApprox(rigid.matrix(), 1e-11));
    EXPECT_LT(found.rmse_m, 1e-11);
    EXPECT_EQ(found.overlap, 1.0);
  }
  const Alignment found = aligned(source, moved(source, scaled), TrajectoryFit::kSim3);
  EXPECT_TRUE(found.T_dst_src.isApprox(scaled.matrix(), 1e-11));
  EXPECT_NEAR(found.scale, scaled.scale, 1e-11 * scaled.scale);
}

TEST(AlignTrajectories, OtherStampsAndPartialOverlap) {
  std::mt19937_64 random(2);
  const Similarity T = test::random_similarity(random, 1.0, 1.0, 10.0);
  const Trajectory source = curve(0.03, 20.0);
  const Alignment found = aligned(source, moved(curve(10.0, 30.0), T), TrajectoryFit::kSe3);
  // Chords of 0.1 s on a path of radius 10 m and acceleration 1 m/s^2: off by at most 1 (0.1)^2 / 8 = 1.3 mm.
  EXPECT_LT(found.rmse_m, 2e-3);
  EXPECT_NEAR(found.overlap, 0.5, 0.01);
  EXPECT_LT(test::angle_between_deg(similarity_from(found.T_dst_src), T), 0.02);
}

TEST(AlignTrajectories, RefusesWhatCannotBe) {
  const Trajectory early = curve(0.0, 5.0), late = curve(100.0, 105.0);
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { aligned(early, late, TrajectoryFit::kSe3); }),
              HasSubstr("the times do not meet: the source is from 0 to"));
  Trajectory nanoseconds = late;
  for (StampedPose& pose : nanoseconds) pose.time_s *= 1e9;
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { aligned(nanoseconds, early, TrajectoryFit::kSe3); }),
              HasSubstr("are those of the source nanoseconds?"));
  Trajectory straight = early;
  for (StampedPose& pose : straight) pose.position = {0, pose.time_s, 0};
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { aligned(straight, straight, TrajectoryFit::kSe3); }),
              HasSubstr("the rotation about (0.00, 1.00, 0.00)"));
  EXPECT_NO_THROW(aligned(straight, straight, TrajectoryFit::kFirstFrame));
  Trajectory hovering = early;
  for (StampedPose& pose : hovering) pose.position = {1, 2, 3};
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { aligned(hovering, early, TrajectoryFit::kSim3); }),
              HasSubstr("coincide"));
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { aligned({}, early, TrajectoryFit::kSe3); }),
              HasSubstr("without poses"));
}

TEST(AlignTrajectories, NearlyStraightPathsAreFlagged) {
  Trajectory source = curve(0.0, 10.0);
  for (StampedPose& pose : source) pose.position = {0.01 * std::sin(pose.time_s), 10.0 * pose.time_s, 0};
  const Alignment found = aligned(source, source, TrajectoryFit::kSe3);
  EXPECT_EQ(found.weakest, "rotation about (0.00, 1.00, 0.00)");
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_THAT(found.warnings[0], HasSubstr("weakly determined"));
}

std::string refusal(const Trajectory& source, const Trajectory& target, const TrajectoryOptions& options = {}) {
  return test::refusal_of<UnsupportedError>([&] { align_trajectories(source, target, options); });
}

TEST(AlignTrajectories, GapsAreNamedWithTheOptionThatTakesThem) {
  const Trajectory sparse = curve(0.0, 20.0, 1.0), shifted = curve(0.05, 20.0);
  EXPECT_THAT(refusal(shifted, sparse), HasSubstr("1 to 1 s apart; --max-gap takes longer gaps"));
  TrajectoryOptions nearest;
  nearest.pairing = TimePairing::kNearest;
  EXPECT_THAT(refusal(shifted, sparse, nearest), HasSubstr("--max-difference takes larger ones"));
  nearest.max_difference_s = 0.06;
  EXPECT_EQ(align_trajectories(shifted, sparse, nearest).n_matches, 21U) << "each of the sparse ones";
  Trajectory gap = curve(0.0, 20.0);
  gap.erase(gap.begin() + 50, gap.begin() + 80);
  EXPECT_THAT(
      aligned(curve(0.05, 19.0), gap, TrajectoryFit::kSe3).warnings,
      ElementsAre(AllOf(HasSubstr("have no pair"), HasSubstr("up to 3.1 s apart, more than --max-gap, 0.15 s"))));
}

TEST(AlignTrajectories, PosesThatJumpAreLeftOutAndNamed) {
  std::mt19937_64 random(3);
  const Similarity T = test::random_similarity(random, 0.5, 2.0, 100.0);
  const Trajectory truth = curve(0.0, 12.0);
  Trajectory jumping = noisy(truth, 0.001, 1);
  jumping[20].position += Eigen::Vector3d(50, 0, 3);
  jumping[77].position = Eigen::Vector3d(1e4, 1e4, 0);
  const TrajectoryAlignment found = aligned(jumping, moved(truth, T), TrajectoryFit::kSim3);
  EXPECT_THAT(found.misfit_times_s, ElementsAre(jumping[20].time_s, jumping[77].time_s));
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("2 of 121 poses do not fit and are left out, at 2.000, 7.700 s")));
  EXPECT_EQ(found.n_matches, 119U);
  EXPECT_EQ(found.judgment.verdict, Verdict::kDetermined);
  // A millimeter of noise on each coordinate, 119 poses.
  EXPECT_NEAR(found.rmse_m, std::sqrt(3.0) * 0.001 * T.scale, 0.0002 * T.scale);
  EXPECT_LT((similarity_from(found.T_dst_src) * truth[0].position - T * truth[0].position).norm(), 0.001 * T.scale);
  EXPECT_GT(found.errors.front().rmse_m, 1.0) << "of all of them, as evo has it";
}

TEST(AlignTrajectories, ALostPartIsLeftOutWhereMostFits) {
  const Trajectory truth = curve(0.0, 20.0);
  Trajectory lost = noisy(truth, 0.001, 1);
  for (std::size_t i = 140; i < lost.size(); ++i) lost[i].position += Eigen::Vector3d(0, 0, 5);
  const TrajectoryAlignment found = aligned(lost, truth, TrajectoryFit::kSe3);
  EXPECT_EQ(found.misfit_times_s.size(), lost.size() - 140);
  EXPECT_LT((found.T_dst_src - Eigen::Matrix4d::Identity()).norm(), 0.001);
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr(" s and 50 more")));
}

TEST(AlignTrajectories, PlainNoiseAndRestsAreNoMisfits) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Trajectory truth = curve(0.0, 20.0);
    // It stands for two thirds of the time: that most poses agree there says nothing about the rest.
    for (std::size_t i = 60; i < truth.size(); ++i) truth[i].position = truth[60].position;
    const TrajectoryAlignment found =
        aligned(noisy(truth, 0.02, seed), noisy(truth, 0.02, 100 + seed), TrajectoryFit::kSe3);
    EXPECT_EQ(found.misfit_times_s.size(), 0U) << seed;
    EXPECT_EQ(found.rmse_m, found.errors.front().rmse_m) << "the plain fit";
    EXPECT_EQ(found.judgment.verdict, Verdict::kDetermined);
  }
}

TEST(AlignTrajectories, BothPairingsAreTold) {
  const Trajectory source = curve(0.0, 20.0), target = curve(0.004, 20.0);
  TrajectoryOptions nearest;
  nearest.pairing = TimePairing::kNearest;
  const TrajectoryAlignment found = aligned(source, target, TrajectoryFit::kSim3);
  const TrajectoryAlignment other = align_trajectories(source, target, nearest);
  ASSERT_EQ(found.errors.size(), 2U);
  ASSERT_EQ(other.errors.size(), 2U);
  EXPECT_EQ(found.errors[0].pairing, TimePairing::kInterpolated);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(found.errors[i].rmse_m, other.errors[1 - i].rmse_m);
  // At 3 m/s, 4 ms are 12 mm along the path, of which the fit takes what is alike: they turn with it.
  EXPECT_GT(found.errors[1].rmse_m, 2.0 * found.errors[0].rmse_m);
  EXPECT_EQ(other.rmse_m, other.errors[0].rmse_m);
}

TEST(TrajectoryText, HoldsBothErrorsAndTheOffset) {
  TrajectoryAlignment found = aligned(curve(0.0, 20.0), curve(0.004, 20.0), TrajectoryFit::kSim3);
  found.misfit_times_s = {1.5};
  auto json = trajectory_json(found);
  ASSERT_EQ(json.at("ate").size(), 2U);
  EXPECT_EQ(json.at("ate").at(1).at("pairing"), "nearest");
  EXPECT_EQ(json.at("ate").at(1).at("rmse_m"), found.errors[1].rmse_m);
  EXPECT_EQ(json.at("misfit_times_s").at(0), 1.5);
  EXPECT_EQ(json.at("time_offset_s"), 0.0);
  EXPECT_TRUE(json.at("found_time_offset").is_null());
  EXPECT_EQ(trajectory_lines(found).find("time offset"), std::string::npos);
  found.time_offset_s = -0.5;
  EXPECT_THAT(trajectory_lines(found), HasSubstr("\ntime offset -0.500000 s   added to SRC's times\n"));
  found.found_time_offset = TimeOffset{-0.5, 0.25, 0.1, 7};
  EXPECT_THAT(trajectory_lines(found), HasSubstr("SRC's times, standard error 0.25 s\n"));
  EXPECT_EQ(trajectory_json(found).at("found_time_offset").at("n_pairs"), 7);
}

TEST(AlignTrajectories, TheSameHoweverOftenItIsAsked) {
  const Trajectory source = noisy(curve(0.0, 20.0), 0.1, 1), target = curve(0.0, 20.0);
  const TrajectoryAlignment once = aligned(source, target, TrajectoryFit::kSim3);
  const TrajectoryAlignment again = aligned(source, target, TrajectoryFit::kSim3);
  EXPECT_EQ(once.T_dst_src, again.T_dst_src);
  EXPECT_EQ(once.judgment.score, again.judgment.score);
}

}  // namespace trajectory_test
}  // namespace cmap
