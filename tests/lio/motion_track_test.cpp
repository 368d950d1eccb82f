#include "odometry/motion_track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "filter/plane_rows.hpp"
#include "filter/propagation.hpp"

namespace cmap {
namespace motion_track_test {

using Eigen::Vector3d;

constexpr double kBegin_s = 100.0, kStep_s = 0.005;
constexpr int kSteps = 20;

NavState start_state() {
  NavState state;
  state.rotation = rotation_exp({0.4, -0.3, 1.0});
  state.position = {10.0, -20.0, 3.0};
  state.velocity = {8.0, 4.0, -0.5};
  state.gyro_bias = {0.01, 0.02, -0.01};
  return state;
}

/// A tenth of a second of turning and braking, by an IMU, from a state on.
struct Predicted {
  Trajectory poses;
  std::vector<NavState> states;

  explicit Predicted(const NavState& begin) {
    NavState state = begin;
    for (int i = 0;; ++i) {
      states.push_back(state);
      poses.push_back({kBegin_s + kStep_s * i, state.position, state.rotation});
      if (i == kSteps) return;
      state =
          propagated(state, {.duration_s = kStep_s, .rate_radps = {0.3, -0.5, 1.5}, .force_mps2 = {-3.0, 5.0, 9.0}});
    }
  }
  MotionTrack track(std::optional<double> kept_s = std::nullopt) const { return {poses, states.back(), kept_s}; }
};

double distance_m(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}
double turn_rad(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return rotation_angle_rad(a.linear().transpose() * b.linear());
}

TEST(MotionTrack, AsPredictedItIsThePosesBetweenWhichItIsStraight) {
  const Predicted predicted(start_state());
  const MotionTrack track = predicted.track();
  for (int i = 0; i <= kSteps; ++i) {
    const Eigen::Isometry3d T = track.pose(kBegin_s + kStep_s * i, track.predicted());
    // Times at 100 s are known to 1e-14 s.
    EXPECT_LT(distance_m(T, T_world_body(predicted.states[static_cast<std::size_t>(i)])), 1e-11) << i;
  }
  const Eigen::Isometry3d middle = track.pose(kBegin_s + 1.5 * kStep_s, track.predicted());
  const Vector3d expected = 0.5 * (predicted.states[1].position + predicted.states[2].position);
  EXPECT_LT((middle.translation() - expected).norm(), 1e-11);
}

TEST(MotionTrack, EndsAtTheEstimate) {
  const Predicted predicted(start_state());
  StateVector change = StateVector::Zero();
  change.head<9>() << 0.02, -0.03, 0.01, 0.3, -0.2, 0.1, 0.5, 0.4, -0.3;
  for (const std::optional<double> kept_s : {std::optional<double>{}, std::optional(kBegin_s)}) {
    const MotionTrack track = predicted.track(kept_s);
    const NavState estimate = moved(track.predicted(), change);
    EXPECT_LT(distance_m(track.pose(track.end_s(), estimate), T_world_body(estimate)), 1e-12);
    EXPECT_LT(turn_rad(track.pose(track.end_s(), estimate), T_world_body(estimate)), 1e-12);
  }
}

/// Of a change at the beginning: the propagated motion beside what the track makes of its end alone.
void expect_like_propagation(const StateVector& change_at_begin, double tolerance_m, double tolerance_rad) {
  const Predicted predicted(start_state()), changed(moved(start_state(), change_at_begin));
  const MotionTrack track = predicted.track();
  for (int i = 0; i <= kSteps; i += 5) {
    const Eigen::Isometry3d found = track.pose(kBegin_s + kStep_s * i, changed.states.back());
    const Eigen::Isometry3d expected = T_world_body(changed.states[static_cast<std::size_t>(i)]);
    EXPECT_LT(distance_m(found, expected), tolerance_m) << i;
    EXPECT_LT(turn_rad(found, expected), tolerance_rad) << i;
  }
}

TEST(MotionTrack, ChangesWithTheEndAsPropagationDoes) {
  StateVector change = StateVector::Zero();
  change.segment<3>(part::kPosition) << 0.3, -0.2, 0.1;
  expect_like_propagation(change, 1e-11, 1e-12);
  change.setZero();
  change.segment<3>(part::kVelocity) << 1.0, -2.0, 0.5;
  expect_like_propagation(change, 1e-11, 1e-12);
  // A turn of 0.02 rad also turns a force of 11 m/s^2: 0.1 s of it are 1.1 mm that the track leaves out.
  change.setZero();
  change.segment<3>(part::kRotation) << 0.012, -0.012, 0.01;
  expect_like_propagation(change, 1.3e-3, 2e-4);
  // A bias of 0.05 rad/s turns by 5 mrad in that time, which bends the way by a third of what a turn does.
  change.setZero();
  change.segment<3>(part::kGyroBias) << 0.03, -0.03, 0.02;
  expect_like_propagation(change, 2e-4, 5e-4);
}

TEST(MotionTrack, WithoutAnImuChangesGrowOverTheScan) {
  const Predicted predicted(start_state());
  const MotionTrack track = predicted.track(kBegin_s);
  StateVector change = StateVector::Zero();
  change.head<6>() << 0.02, -0.03, 0.01, 0.3, -0.2, 0.1;
  const NavState estimate = moved(track.predicted(), change);
  const double first = track.share_at(kBegin_s);
  EXPECT_GE(first, 0.0);
  EXPECT_LT(first, 0.5);
  EXPECT_EQ(track.share_at(kBegin_s - 0.02), first) << "and before";
  EXPECT_NEAR(track.share_at(kBegin_s + 0.025), first + 0.25 * (1.0 - first), 1e-12) << "grows evenly";
  EXPECT_EQ(track.share_at(track.end_s()), 1.0);
  for (const double t : {kBegin_s, kBegin_s + 0.025, kBegin_s + 0.05, kBegin_s + 0.1}) {
    const double share = track.share_at(t);
    const Eigen::Isometry3d before = track.pose(t, track.predicted()), after = track.pose(t, estimate);
    EXPECT_LT((after.translation() - before.translation() - share * Vector3d(0.3, -0.2, 0.1)).norm(), 1e-11) << t;
    EXPECT_NEAR(turn_rad(before, after), share * Vector3d(0.02, -0.03, 0.01).norm(), 1e-9) << t;
  }
}

TEST(MotionTrack, WithAnImuAllOfAChangeIsThereAllAlong) {
  const MotionTrack track = Predicted(start_state()).track();
  EXPECT_EQ(track.share_at(kBegin_s), 1.0);
  EXPECT_EQ(track.share_at(track.end_s()), 1.0);
}

TEST(MotionTrack, BeforeItsFirstPoseItGoesOnBackward) {
  const MotionTrack track = Predicted(start_state()).track();
  const Eigen::Isometry3d T = track.pose(kBegin_s - 0.02, track.predicted());
  const Vector3d expected = start_state().position - 0.02 * track.predicted().velocity;
  EXPECT_LT((T.translation() - expected).norm(), 1e-11);
}

TEST(MotionTrack, PlaneJacobianIsTheDerivativeAtAnyTime) {
  const Predicted predicted(start_state());
  const Vector3d point(7.0, -4.0, 2.0), normal = Vector3d(0.3, -0.5, 0.8).normalized(), center(15.0, -18.0, 4.0);
  for (const std::optional<double> kept_s : {std::optional<double>{}, std::optional(kBegin_s)}) {
    const MotionTrack track = predicted.track(kept_s);
    for (const double t : {kBegin_s, kBegin_s + 0.03, kBegin_s + 0.1}) {
      const auto residual = [&](const NavState& state) { return normal.dot(track.pose(t, state) * point - center); };
      const Eigen::Isometry3d T = track.pose(t, track.predicted());
      const Eigen::Matrix3d R_end = track.predicted().rotation.toRotationMatrix();
      const PoseVector found =
          plane_jacobian(R_end, normal, R_end.transpose() * (T * point - T.translation()), track.share_at(t));
      for (int axis = 0; axis < 6; ++axis) {
        const StateVector d = 1e-6 * StateVector::Unit(axis);
        const double numeric = (residual(moved(track.predicted(), d)) - residual(moved(track.predicted(), -d))) / 2e-6;
        // Rounding of some 20 m by a step of 1e-6.
        EXPECT_NEAR(found[axis], numeric, 1e-7) << t << ", " << axis << (kept_s ? ", kept" : "");
      }
    }
  }
}

TEST(ScanPoses, AreThoseOfTheTrackToHalfAStep) {
  const MotionTrack track = Predicted(start_state()).track();
  Eigen::Isometry3d T_body_lidar = Eigen::Isometry3d::Identity();
  T_body_lidar.translation() = Vector3d(0.1, 0.2, 0.3);
  T_body_lidar.linear() = rotation_from({0.1, 1.2, -0.4});
  const ScanPoses poses(track, track.predicted(), T_body_lidar, 0.1);
  for (const float before_s : {0.0F, 0.0001F, 0.0123F, 0.05F, 0.0777F, 0.1F}) {
    const Eigen::Isometry3d T = track.pose(track.end_s() - static_cast<double>(before_s), track.predicted());
    const ScanPoses::Pose& found = poses.at(before_s);
    // Half of a step of 0.39 ms: 9 m/s and 1.6 rad/s.
    EXPECT_LT((found.body_position - T.translation()).norm(), 2e-4 * 9.1 + 1e-6) << before_s;
    EXPECT_LT(turn_rad(found.T_world_lidar, T * T_body_lidar), 2e-4 * 1.65) << before_s;
    EXPECT_EQ(found.share, 1.0);
  }
  EXPECT_LT(distance_m(poses.at(0.0F).T_world_lidar, T_world_body(track.predicted()) * T_body_lidar), 1e-12)
      << "the end exactly";
}

TEST(ScanPoses, OfAnInstantAreOne) {
  const MotionTrack track = Predicted(start_state()).track();
  const ScanPoses poses(track, track.predicted(), Eigen::Isometry3d::Identity(), 0.0);
  EXPECT_LT(distance_m(poses.at(0.0F).T_world_lidar, T_world_body(track.predicted())), 1e-12);
}

}  // namespace motion_track_test
}  // namespace cmap
