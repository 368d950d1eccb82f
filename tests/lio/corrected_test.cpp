#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "cmap/geometry/rotation.hpp"
#include "cmap/lio/loop_closure.hpp"

namespace cmap {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;

Eigen::Isometry3d rigid(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& position) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation_from(turn_rad);
  T.translation() = position;
  return T;
}

/// Along a bend, far from the world's origin, as UTM has it.
Eigen::Isometry3d on_bend(double t) {
  return rigid({0.0, 0.0, 0.3 * t},
               Eigen::Vector3d(4.5e5 + 10.0 * std::sin(0.3 * t), 5.4e6 - 10.0 * std::cos(0.3 * t), 1.0));
}

StampedPose at_time(double t, const Eigen::Isometry3d& T) {
  return {t, T.translation(), Eigen::Quaterniond(T.linear())};
}

Trajectory bend(double first_s, double last_s, int n) {
  Trajectory trajectory;
  for (int i = 0; i < n; ++i) {
    const double t = first_s + (last_s - first_s) * i / (n - 1);
    trajectory.push_back(at_time(t, on_bend(t)));
  }
  return trajectory;
}

void expect_equal(const StampedPose& found, const Eigen::Isometry3d& expected, double tolerance) {
  EXPECT_LT((found.position - expected.translation()).norm(), tolerance);
  EXPECT_LT(Eigen::Quaterniond(expected.linear()).angularDistance(found.rotation), tolerance);
}

const std::vector<double> kKeyframeTimes_s{1.0, 2.0, 4.0};
const Poses kBefore{on_bend(1.0), on_bend(2.0), on_bend(4.0)};

TEST(Corrected, NothingChangesWhereKeyframesStay) {
  for (const StampedPose& p : corrected(bend(0.0, 6.0, 61), kKeyframeTimes_s, kBefore, kBefore)) {
    expect_equal(p, on_bend(p.time_s), 1e-8);
  }
}

TEST(Corrected, OneMotionOfAllKeyframesMovesAllPosesByIt) {
  const Eigen::Isometry3d motion = rigid({0.01, -0.02, 0.5}, {3.0, -2.0, 1.0});
  Poses after;
  for (const Eigen::Isometry3d& T : kBefore) after.push_back(motion * T);
  for (const StampedPose& p : corrected(bend(0.0, 6.0, 61), kKeyframeTimes_s, kBefore, after)) {
    expect_equal(p, motion * on_bend(p.time_s), 1e-8);
  }
}

const Poses kAfter{kBefore[0], kBefore[1] * rigid({0.0, 0.0, 0.02}, {0.1, 0.3, 0.0}),
                   kBefore[2] * rigid({0.01, 0.0, 0.05}, {-0.2, 0.6, 0.1})};

TEST(Corrected, KeyframesAreMetExactly) {
  Trajectory at_keyframes;
  for (std::size_t k = 0; k < kKeyframeTimes_s.size(); ++k)
    at_keyframes.push_back(at_time(kKeyframeTimes_s[k], kBefore[k]));
  const Trajectory result = corrected(at_keyframes, kKeyframeTimes_s, kBefore, kAfter);
  for (std::size_t k = 0; k < kKeyframeTimes_s.size(); ++k) expect_equal(result[k], kAfter[k], 1e-8);
}

TEST(Corrected, PosesOutsideMoveWithTheEnds) {
  const Trajectory result = corrected(bend(0.0, 6.0, 7), kKeyframeTimes_s, kBefore, kAfter);
  expect_equal(result.front(), kAfter[0] * kBefore[0].inverse() * on_bend(0.0), 1e-8);
  expect_equal(result.back(), kAfter[2] * kBefore[2].inverse() * on_bend(6.0), 1e-8);
}

TEST(Corrected, NoJumpsBetweenKeyframes) {
  const Trajectory before = bend(0.0, 6.0, 6001), after = corrected(before, kKeyframeTimes_s, kBefore, kAfter);
  double longest_m = 0.0;
  for (std::size_t i = 1; i < after.size(); ++i) {
    const Eigen::Vector3d step = after[i].position - after[i - 1].position;
    longest_m = std::max(longest_m, (step - (before[i].position - before[i - 1].position)).norm());
  }
  EXPECT_LT(longest_m, 1e-3);  // 0.7 m of correction over 3000 steps
}

TEST(Corrected, HalfTheWayHalfTheCorrection) {
  const Poses before{Eigen::Isometry3d::Identity(), rigid({0, 0, 0}, {2, 0, 0})};
  const Poses after{Eigen::Isometry3d::Identity(), rigid({0, 0, 0}, {2, 0.4, 0})};
  const Trajectory odometry{at_time(5.0, rigid({0, 0, 0}, {1, 0, 0}))};
  const std::vector<double> times_s{4.0, 6.0};
  expect_equal(corrected(odometry, times_s, before, after).front(), rigid({0, 0, 0}, {1, 0.2, 0}), 1e-12);
}

TEST(Corrected, RefusesWhatDoesNotBelongTogether) {
  const std::vector<double> two{1.0, 2.0}, back{1.0, 1.0, 2.0};
  EXPECT_THROW(corrected({}, {}, {}, {}), std::invalid_argument);
  EXPECT_THROW(corrected({}, two, kBefore, kAfter), std::invalid_argument);
  EXPECT_THROW(corrected({}, kKeyframeTimes_s, kBefore, Poses(2)), std::invalid_argument);
  EXPECT_THROW(corrected({}, back, kBefore, kAfter), std::invalid_argument);
}

}  // namespace
}  // namespace cmap
