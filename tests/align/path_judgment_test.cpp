// What alignments of trajectories say of themselves.

#include "align/align_testing.hpp"
#include "align/trajectories.hpp"

namespace cmap {
namespace path_judgment_test {

using test::along;
using test::curve;
using test::moved;
using test::noisy;
using ::testing::HasSubstr;

Judgment judgment_of(const Trajectory& source, const Trajectory& target, TrajectoryFit fit = TrajectoryFit::kSim3) {
  TrajectoryOptions options;
  options.fit = fit;
  return align_trajectories(source, target, options).judgment;
}

Trajectory mirrored(Trajectory trajectory) {
  for (StampedPose& pose : trajectory) pose.position.y() *= -1.0;
  return trajectory;
}

/// A smooth path to nowhere in particular.
Trajectory wandering(unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::Matrix3d amplitude, phase, rate;
  for (Eigen::Matrix3d* m : {&amplitude, &phase, &rate}) {
    for (double& v : m->reshaped()) v = normal(random);
  }
  return along(20.0, [&](double t) {
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = 0.0;
      for (int k = 0; k < 3; ++k)
        p[axis] += amplitude(axis, k) * std::sin((0.3 + 0.3 * k) * t * rate(axis, k) + phase(axis, k));
    }
    return p;
  });
}

TEST(JudgePaths, ACopyWithNoiseIsDetermined) {
  std::mt19937_64 random(1);
  for (const double sigma_m : {0.0, 0.01, 0.3}) {
    const Similarity T = test::random_similarity(random, 0.1, 10.0, 1000.0);
    const Judgment found = judgment_of(noisy(curve(0.0, 20.0), sigma_m, 1), moved(curve(0.0, 20.0), T));
    EXPECT_EQ(found.verdict, Verdict::kDetermined) << sigma_m << ": " << found.reason;
    EXPECT_GT(found.score, 0.99);
    EXPECT_TRUE(found.help.empty());
  }
}

TEST(JudgePaths, AStraightPathLeavesTheTurnAboutItToNoise) {
  const Eigen::Vector3d direction = Eigen::Vector3d(1, 2, 2) / 3.0;
  for (const double sigma_m : {0.002, 0.1}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const Trajectory straight = along(20.0, [&](double t) { return 6.0 * t * direction; });
      for (const TrajectoryFit fit : {TrajectoryFit::kSe3, TrajectoryFit::kSim3}) {
        const Judgment found = judgment_of(noisy(straight, sigma_m, seed), noisy(straight, sigma_m, 100 + seed), fit);
        EXPECT_EQ(found.verdict, Verdict::kUnsupported) << sigma_m << " " << seed << ": " << found.reason;
        EXPECT_THAT(found.reason, HasSubstr("(0.33, 0.67, 0.67)"));
        EXPECT_THAT(found.reason, HasSubstr("the rotation about it is not determined"));
        EXPECT_THAT(
            test::refusal_of<UnsupportedError>([&] { judgment_of(noisy(straight, sigma_m, seed), straight, fit); }),
            HasSubstr("the rotation about (0.33, 0.67, 0.67)"))
            << "an exact line on one side";
      }
    }
  }
}

TEST(JudgePaths, BetweenNoiseAndABendTheTurnIsWeak) {
  // 5 cm of noise on each of three axes: a residual of 9 cm. The bend's spread across is A / sqrt 2 and 7 cm of noise.
  const auto bent = [](double a_m) {
    return along(20.0, [=](double t) { return Eigen::Vector3d(6 * t, a_m * std::sin(t), 0); });
  };
  const Judgment weak = judgment_of(noisy(bent(0.3), 0.05, 1), bent(0.3), TrajectoryFit::kSe3);
  EXPECT_EQ(weak.verdict, Verdict::kWeak) << weak.reason;
  ASSERT_EQ(weak.weak.size(), 1U);
  EXPECT_EQ(weak.weak[0].name, "rotation about (1.00, 0.00, 0.00)");
  EXPECT_EQ(judgment_of(noisy(bent(0.03), 0.05, 1), bent(0.03), TrajectoryFit::kSe3).verdict, Verdict::kUnsupported);
  EXPECT_EQ(judgment_of(noisy(bent(1.0), 0.05, 1), bent(1.0), TrajectoryFit::kSe3).verdict, Verdict::kDetermined);
}

/// The standard error that is told is what the turn is really off by.
TEST(JudgePaths, TheStandardErrorOfAWeakTurnIsCalibrated) {
  const Trajectory bent = along(20.0, [](double t) { return Eigen::Vector3d(6 * t, 0.3 * std::sin(t), 0); });
  double sum_sq_error_m = 0.0, sum_sq_told_m = 0.0;
  int n = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    TrajectoryOptions options;
    options.fit = TrajectoryFit::kSe3;
    const TrajectoryAlignment found = align_trajectories(noisy(bent, 0.05, seed), bent, options);
    if (found.judgment.weak.empty()) continue;
    const Eigen::Matrix3d R = found.T_dst_src.topLeftCorner<3, 3>();
    const double turn = std::atan2(R(2, 1), R(1, 1));
    const double spread_m = 6.0 * 20.0 / std::sqrt(12.0);
    sum_sq_error_m += std::pow(turn * spread_m, 2);
    sum_sq_told_m += std::pow(found.judgment.weak[0].standard_error_m, 2);
    ++n;
  }
  ASSERT_GT(n, 50);
  EXPECT_NEAR(std::log(std::sqrt(sum_sq_told_m / sum_sq_error_m)), 0.0, std::log(1.5));
}

TEST(JudgePaths, WhatStandsStillIsNotScaledToThePath) {
  const Trajectory still = noisy(along(20.0, [](double) { return Eigen::Vector3d(1, 2, 3); }), 0.001, 1);
  const Judgment found = judgment_of(still, curve(0.0, 20.0));
  EXPECT_EQ(found.verdict, Verdict::kUnsupported);
  EXPECT_THAT(found.reason, HasSubstr("the source stands still"));
  EXPECT_THAT(judgment_of(curve(0.0, 20.0), still).reason, HasSubstr("the target stands still"));
  EXPECT_THAT(judgment_of(still, curve(0.0, 20.0), TrajectoryFit::kSe3).reason, HasSubstr("the source stands still"));
}

TEST(JudgePaths, UnrelatedPathsAreTold) {
  int n_taken = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const Judgment found = judgment_of(wandering(seed), wandering(1000 + seed));
    n_taken += is_trusted(found.verdict) && found.weak.empty() ? 1 : 0;
    EXPECT_FALSE(found.reason.empty());
  }
  EXPECT_LE(n_taken, 1) << "by chance two may be alike";
  const Judgment found = judgment_of(wandering(3), wandering(1003), TrajectoryFit::kFirstFrame);
  EXPECT_EQ(found.verdict, Verdict::kUnsupported);
  EXPECT_THAT(found.reason, HasSubstr("the paths do not fit: the RMSE is"));
}

TEST(JudgePaths, AnotherScaleIsTheHelp) {
  std::mt19937_64 random(1);
  const Similarity T = test::random_similarity(random, 3.0, 3.0, 10.0);
  const Judgment found = judgment_of(curve(0.0, 20.0), moved(curve(0.0, 20.0), T), TrajectoryFit::kSe3);
  EXPECT_EQ(found.verdict, Verdict::kUnsupported);
  EXPECT_THAT(found.help, HasSubstr("--fit sim3 finds a scale of 3 "));
}

TEST(JudgePaths, AMirrorImageIsTold) {
  std::mt19937_64 random(1);
  const Similarity T = test::random_similarity(random, 1.0, 1.0, 10.0);
  for (const TrajectoryFit fit : {TrajectoryFit::kSe3, TrajectoryFit::kSim3, TrajectoryFit::kFirstFrame}) {
    for (const double sigma_m : {0.0, 0.05}) {
      const Trajectory source = noisy(mirrored(curve(0.0, 20.0)), sigma_m, 1);
      const Judgment found = judgment_of(source, moved(curve(0.0, 20.0), T), fit);
      EXPECT_EQ(found.verdict, Verdict::kMirrored) << found.reason;
      EXPECT_THAT(found.help, HasSubstr("left-handed"));
      EXPECT_EQ(judgment_of(mirrored(source), moved(curve(0.0, 20.0), T), TrajectoryFit::kSe3).verdict,
                Verdict::kDetermined);
    }
  }
}

TEST(JudgePaths, OfAFlatPathNoMirrorImageIsKnown) {
  const auto flat = [](Trajectory path) {
    for (StampedPose& pose : path) pose.position.z() = 0.0;
    return path;
  };
  const Trajectory path = flat(curve(0.0, 20.0));
  EXPECT_EQ(judgment_of(noisy(mirrored(path), 0.01, 1), path, TrajectoryFit::kSe3).verdict, Verdict::kDetermined);
}

}  // namespace path_judgment_test
}  // namespace cmap
