#include "cmap/align/time_offset.hpp"

#include "align/align_testing.hpp"
#include "align/trajectories.hpp"
#include "cmap/align/pose_pairs.hpp"

namespace cmap {
namespace time_offset_test {

using test::along;
using test::moved;
using test::noisy;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Where a body is at a time: it turns, slows down and hurries.
Eigen::Vector3d place(double t, double seed) {
  return {8 * std::cos(0.25 * t + seed) + 1.5 * std::sin(0.83 * t), 6 * std::sin(0.31 * t) + std::cos(1.1 * t + seed),
          0.5 * std::sin(0.47 * t + 2 * seed)};
}

/// Poses of it, their stamps jittered as loggers do, the body turning with the path.
Trajectory recorded(double from_s, double to_s, double step_s, double seed, bool with_rotation = true) {
  std::mt19937_64 random(static_cast<unsigned>(1000 * seed + 7 * step_s));
  std::uniform_real_distribution<double> jitter(-0.2 * step_s, 0.2 * step_s);
  Trajectory trajectory;
  for (double t = from_s; t < to_s; t += step_s) {
    const double time_s = t + jitter(random);
    const Eigen::Vector3d ahead = place(time_s + 0.01, seed) - place(time_s - 0.01, seed);
    const Eigen::AngleAxisd heading(std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ());
    trajectory.push_back(
        {time_s, place(time_s, seed), with_rotation ? Eigen::Quaterniond(heading) : Eigen::Quaterniond::Identity()});
  }
  return trajectory;
}

TimeOffset offset_of(const Trajectory& source, const Trajectory& target) {
  const TimeOffsetSearch search = find_time_offset(source, target);
  EXPECT_TRUE(search.found) << search.reason;
  return search.found.value_or(TimeOffset{});
}

/// From clocks that a cable delays to those that count other leap seconds, or from when the machine was started.
TEST(FindTimeOffset, IsWithin5Milliseconds) {
  std::mt19937_64 random(1);
  for (const double offset_s : {-20.0, -18.0, -2.0, -0.05, 0.0, 0.05, 0.3, 1.0, 7.77, 20.0, 1.7e9}) {
    for (const double seed : {0.0, 1.0}) {
      const bool with_rotation = seed == 0.0;
      const Similarity T = test::random_similarity(random, 0.3, 3.0, 100.0);
      const Trajectory source = noisy(recorded(10.0, 70.0, 0.1, seed, with_rotation), 0.005, 1);
      const Trajectory target = moved(shifted_in_time(recorded(0.0, 90.0, 0.05, seed, with_rotation), offset_s), T);
      const TimeOffset found = offset_of(source, target);
      EXPECT_NEAR(found.offset_s, offset_s, 0.005) << with_rotation;
      EXPECT_LT(found.standard_error_s, 0.005);
      EXPECT_LT(found.rmse_m, 0.02 * T.scale);
      EXPECT_NEAR(offset_of(target, source).offset_s, -offset_s, 0.005) << "the other way round";
    }
  }
}

TEST(FindTimeOffset, TheStandardErrorIsCalibrated) {
  double sum_sq_error = 0.0, sum_sq_told = 0.0;
  for (unsigned i = 1; i <= 40; ++i) {
    const Trajectory source = noisy(recorded(0.0, 60.0, 0.1, 0.0), 0.1, i);
    const TimeOffset found = offset_of(source, shifted_in_time(recorded(-10.0, 70.0, 0.05, 0.0), 0.5));
    sum_sq_error += std::pow(found.offset_s - 0.5, 2);
    sum_sq_told += std::pow(found.standard_error_s, 2);
  }
  EXPECT_NEAR(std::log(std::sqrt(sum_sq_told / sum_sq_error)), 0.0, std::log(1.5));
}

TEST(FindTimeOffset, SparseAgainstDenseAndPosesThatJump) {
  Trajectory sparse = recorded(0.0, 120.0, 1.0, 1.0);
  EXPECT_NEAR(offset_of(sparse, shifted_in_time(recorded(0.0, 120.0, 0.1, 1.0), 3.3)).offset_s, 3.3, 0.005);
  Trajectory jumping = noisy(recorded(0.0, 60.0, 0.1, 1.0), 0.005, 1);
  jumping[100].position += Eigen::Vector3d(40, 0, 0);
  jumping[300].position += Eigen::Vector3d(0, 90, 0);
  EXPECT_NEAR(offset_of(jumping, shifted_in_time(recorded(0.0, 60.0, 0.05, 1.0), -4.2)).offset_s, -4.2, 0.005);
}

std::string doubt_of(const Trajectory& source, const Trajectory& target) {
  const TimeOffsetSearch search = find_time_offset(source, target);
  EXPECT_FALSE(search.found) << search.found->offset_s;
  return search.reason;
}

/// Where the path looks the same at any time, no offset is invented, whatever the noise.
TEST(FindTimeOffset, IsRefusedWhereMotionDoesNotTell) {
  const auto straight = [](double t) { return Eigen::Vector3d(6 * t, 2 * t, 0); };
  const auto circle = [](double t) { return Eigen::Vector3d(10 * std::cos(0.3 * t), 10 * std::sin(0.3 * t), 0); };
  const auto still = [](double) { return Eigen::Vector3d(1, 2, 3); };
  for (const double sigma_m : {0.0, 0.002, 0.05}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const auto twice = [&](const Trajectory& path) {
        return doubt_of(noisy(path, sigma_m, seed), noisy(shifted_in_time(path, 0.7), sigma_m, 100 + seed));
      };
      EXPECT_NE(twice(along(60.0, straight)), "");
      EXPECT_NE(twice(along(60.0, circle)), "");
      EXPECT_NE(twice(along(60.0, still)), "");
    }
  }
}

TEST(FindTimeOffset, IsRefusedBetweenOtherPathsAndWhereSeveralFit) {
  EXPECT_NE(doubt_of(recorded(0.0, 60.0, 0.1, 0.0),
                     along(60.0, [](double t) { return Eigen::Vector3d(std::sin(0.2 * t * t), std::cos(t), t); })),
            "");
  // Laps of a figure of eight, each as the one before.
  const auto laps = [](double t) { return Eigen::Vector3d(10 * std::sin(0.4 * t), 5 * std::sin(0.8 * t), 0); };
  EXPECT_THAT(doubt_of(noisy(along(80.0, laps), 0.01, 1), noisy(along(80.0, laps), 0.01, 2)), HasSubstr("fit alike"));
  EXPECT_THAT(doubt_of({}, recorded(0.0, 60.0, 0.1, 0.0)), HasSubstr("fewer than 8 poses"));
}

TrajectoryAlignment aligned(const Trajectory& source, const Trajectory& target, bool find) {
  TrajectoryOptions options;
  options.find_time_offset = find;
  return align_trajectories(source, target, options);
}

TEST(AlignTrajectories, AnOffsetIsToldAndTakenOnlyWhereItIsAskedFor) {
  const Trajectory source = noisy(recorded(0.0, 60.0, 0.1, 1.0), 0.005, 1);
  const Trajectory target = shifted_in_time(recorded(-5.0, 65.0, 0.05, 1.0), 0.4);
  const TrajectoryAlignment plain = aligned(source, target, false);
  EXPECT_EQ(plain.time_offset_s, 0.0);
  ASSERT_TRUE(plain.found_time_offset);
  EXPECT_NEAR(plain.found_time_offset->offset_s, 0.4, 0.005);
  EXPECT_THAT(plain.warnings,
              ElementsAre(AllOf(HasSubstr("the clocks differ: --time-offset 0."), HasSubstr("it is not applied"))));
  const TrajectoryAlignment found = aligned(source, target, true);
  EXPECT_NEAR(found.time_offset_s, 0.4, 0.005);
  EXPECT_LT(found.rmse_m, 0.1 * plain.rmse_m);
  EXPECT_THAT(found.warnings, ElementsAre());
  TrajectoryOptions given;
  given.time_offset_s = 0.4;
  const TrajectoryAlignment taken = align_trajectories(source, target, given);
  EXPECT_THAT(taken.warnings, ElementsAre()) << "nothing is left to tell";
  EXPECT_NEAR(taken.rmse_m, found.rmse_m, 0.2 * found.rmse_m);
}

TEST(AlignTrajectories, SayWhyNoOffsetIsFound) {
  const auto straight = along(60.0, [](double t) { return Eigen::Vector3d(6 * t, 2 * t, 0); });
  EXPECT_THAT(
      test::refusal_of<UnsupportedError>([&] { aligned(noisy(straight, 0.01, 1), noisy(straight, 0.01, 2), true); }),
      HasSubstr("the offset between the clocks is not determined: "));
}

TEST(AlignTrajectories, WithTheSameClockNoneIsTold) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Trajectory source = noisy(recorded(0.0, 60.0, 0.1, 0.1 * seed), 0.05, seed);
    EXPECT_THAT(aligned(source, recorded(-1.0, 61.0, 0.05, 0.1 * seed), false).warnings, ElementsAre());
  }
}

}  // namespace time_offset_test
}  // namespace cmap
