#include "cmap/recon/pre_fusion.hpp"

#include "recon/recon_testing.hpp"

namespace cmap {
namespace pre_fusion_test {

using ::testing::HasSubstr;

/// A drive of 6 s at 10 m/s along a curve; the body looks ahead.
StampedPose body_at(double t) {
  const double heading = 0.1 * t;
  return {t,
          {100 * std::sin(heading), 100 * (1 - std::cos(heading)), 0},
          Eigen::Quaterniond(rotation_from({0, 0, heading}))};
}

CameraMount mount() {
  CameraMount mount;
  mount.T_imu_lidar.translation() << 0.1, 0, 0.3;
  mount.T_lidar_camera.linear() = rotation_from({-M_PI_2, 0, 0}) * rotation_from({0, M_PI_2, 0});
  mount.T_lidar_camera.translation() << 0.5, 0.2, -0.1;
  return mount;
}

struct Drive {
  std::vector<Similarity> truth;  ///< world from session
  std::vector<std::vector<SessionFrame>> sessions;
  std::vector<OdometryPoses> T_world_camera;
  std::vector<std::optional<ScaleRatio>> ratios;
};

OdometryPoses poses_of(const std::vector<SessionFrame>& session, PosePairing pairing) {
  Trajectory trajectory;
  for (int i = 0; i <= 70; ++i) trajectory.push_back(body_at(0.1 * i));
  std::vector<double> times_s;
  for (const SessionFrame& frame : session) times_s.push_back(frame.time_s);
  return camera_poses(trajectory, mount(), times_s, pairing);
}

/// Five sessions of 16 images with units of their own; stamps between those of the trajectory.
Drive drive(PosePairing pairing = PosePairing::kInterpolated) {
  Drive d;
  const Eigen::Isometry3d T_imu_camera = mount().T_imu_lidar * mount().T_lidar_camera;
  std::mt19937_64 random(1);
  for (std::size_t k = 0; k < 5; ++k) {
    d.truth.push_back(test::random_similarity(random, 5.0, 40.0, 50.0));
    const Similarity session_world = d.truth[k].inverse();
    d.sessions.emplace_back();
    for (int i = 0; i < 16; ++i) {
      const double t = 0.03 + 1.1 * static_cast<double>(k) + 0.1 * i;
      const StampedPose body = body_at(t);
      const Eigen::Isometry3d T_world_camera = Eigen::Translation3d(body.position) * body.rotation * T_imu_camera;
      SessionFrame frame{t, Eigen::Isometry3d::Identity()};
      const Eigen::Matrix3d R = session_world.rotation * T_world_camera.linear();
      frame.T_camera_session.linear() = R.transpose();
      frame.T_camera_session.translation() = -(R.transpose() * (session_world * T_world_camera.translation()));
      d.sessions.back().push_back(frame);
    }
    d.T_world_camera.push_back(poses_of(d.sessions.back(), pairing));
    if (k > 0) d.ratios.push_back(ScaleRatio{d.truth[k].scale / d.truth[k - 1].scale, 0.005, 1000});
  }
  return d;
}

double scale_error(const Drive& d, const PreFusion& result, std::size_t k) {
  return std::abs(result.T_world_session[k].scale / d.truth[k].scale - 1.0);
}

TEST(PreFusion, LaysSessionsOnTheWorld) {
  const Drive d = drive();
  const PreFusion result = pre_fuse(d.sessions, d.T_world_camera, d.ratios);
  for (std::size_t k = 0; k < 5; ++k) {
    // Chords of 1 m on a circle of 100 m are 1.25 mm off at most, over paths of 15 m.
    EXPECT_LT(scale_error(d, result, k), 2e-4);
    EXPECT_LT(test::rotation_error_deg(result.T_world_session[k].rotation, d.truth[k].rotation), 0.02);
    for (const SessionFrame& frame : d.sessions[k]) {
      const Eigen::Vector3d x = camera_center(frame);
      EXPECT_LT((result.T_world_session[k] * x - d.truth[k] * x).norm(), 0.005);
    }
    EXPECT_TRUE(result.voted.is_inlier[k]);
  }
}

TEST(PreFusion, NearestPosesAreOffByTheirTime) {
  const Drive d = drive(PosePairing::kNearest);
  const PreFusion result = pre_fuse(d.sessions, d.T_world_camera, d.ratios, PreFusionOptions::paper());
  // Images come 0.03 s after a pose, at 10 m/s: 0.3 m along the path, the same for all.
  const Eigen::Vector3d x = camera_center(d.sessions[2][8]);
  EXPECT_NEAR((result.T_world_session[2] * x - d.truth[2] * x).norm(), 0.3, 0.02);
}

TEST(PreFusion, AHoveringSessionTakesItsNeighborsScale) {
  Drive d = drive();
  for (std::size_t i = 1; i < d.sessions[3].size(); ++i) {
    d.sessions[3][i] = d.sessions[3][0];
    d.sessions[3][i].time_s += 1e-4 * static_cast<double>(i);
  }
  d.T_world_camera[3] = poses_of(d.sessions[3], PosePairing::kInterpolated);
  const PreFusion result = pre_fuse(d.sessions, d.T_world_camera, d.ratios);
  EXPECT_FALSE(result.placements[3].has_baseline);
  EXPECT_FALSE(result.voted.is_inlier[3]);
  EXPECT_LT(scale_error(d, result, 3), 1e-3);
  const Eigen::Vector3d x = camera_center(d.sessions[3][0]);
  EXPECT_LT((result.T_world_session[3] * x - d.truth[3] * x).norm(), 0.02);
}

TEST(PreFusion, AWrongPlacementIsOutvoted) {
  Drive d = drive();
  // The session's path is stretched against its depths: its scale comes out 20 % small.
  for (SessionFrame& frame : d.sessions[1]) frame.T_camera_session.translation() *= 1.25;
  const PreFusion result = pre_fuse(d.sessions, d.T_world_camera, d.ratios);
  EXPECT_NEAR(result.placements[1].T_world_session.scale / d.truth[1].scale, 0.8, 0.01);
  EXPECT_FALSE(result.voted.is_inlier[1]);
  EXPECT_LT(scale_error(d, result, 1), 1e-3);
  // The mean of the centers stays where the trajectory has it.
  const SessionPlacement& r = result.placements[1];
  EXPECT_LT((result.T_world_session[1] * r.mean_session - r.mean_world).norm(), 1e-9);
}

TEST(PreFusion, NamesTheSessionWithoutPoses) {
  Drive d = drive();
  d.T_world_camera[2].assign(d.sessions[2].size(), std::nullopt);
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { pre_fuse(d.sessions, d.T_world_camera, d.ratios); }),
              HasSubstr("session 2: no frame of the session has a camera pose"));
}

}  // namespace pre_fusion_test
}  // namespace cmap
