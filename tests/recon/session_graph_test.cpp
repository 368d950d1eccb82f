#include "cmap/recon/session_graph.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cmap {
namespace {

constexpr int kWidth = 40, kHeight = 30;

/// Depth of a bumpy scene before camera `frame` that moves along x by a meter each: what both sessions see of it.
double scene_depth(int u, int v, int frame) { return 6.0 + 2.0 * std::sin(0.3 * u + frame) + 1.5 * std::cos(0.4 * v); }

/// A session of frames first ... first + n - 1, its unit `unit` meters; frame f's camera is at x = f.
SessionPredictions session_of(int first, int n, double unit) {
  SessionPredictions session;
  session.width = kWidth;
  session.height = kHeight;
  for (int i = 0; i < n; ++i) {
    session.frames.push_back({static_cast<std::size_t>(i), 0.5 * (first + i), "", kWidth, kHeight});
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation().x() = -i / unit;
    session.T_camera_session.push_back(T);
    session.intrinsics.push_back((Eigen::Matrix3d() << 30, 0, 20, 0, 30, 15, 0, 0, 1).finished());
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        session.depth.push_back(static_cast<float>(scene_depth(u, v, first + i) / unit));
        session.depth_confidence.push_back(3.0f);
        session.images.push_back({100, 100, 100});
      }
    }
  }
  return session;
}

Similarity at(double scale, const Eigen::Vector3d& translation, double turn_rad) {
  Similarity T;
  T.scale = scale;
  T.rotation = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  T.translation = translation;
  return T;
}

TEST(SessionGraph, FramesOfASessionAreWhereTheSimilarityPutsThem) {
  const SessionPredictions session = session_of(0, 3, 2.0);
  const PlacedSession placed = placed_session(4, frames_of(session), at(2.0, {1, 2, 3}, 0.0), 0.1);
  EXPECT_EQ(placed.index, 4u);
  EXPECT_EQ(placed.time_s, (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_LT((placed.T_world_camera[2].translation() - Eigen::Vector3d(3, 2, 3)).norm(), 1e-12) << "2 m along x";
}

/// Two sessions of different units; the second is displaced by a known motion: the link brings it back.
TEST(SessionGraph, ALinkFindsTheMotionBetweenSessions) {
  const SessionPredictions a = session_of(0, 6, 2.0), b = session_of(4, 6, 0.5);
  const PlacedSession placed_a = placed_session(0, frames_of(a), at(2.0, {0, 0, 0}, 0.0), 0.1);
  const Similarity truth = at(0.5, {4, 0, 0}, 0.0);
  const Similarity error = at(1.0, {0.15, -0.1, 0.08}, 0.01);
  const PlacedSession placed_b = placed_session(1, frames_of(b), error * truth, 0.1);
  std::string reason;
  const auto link = link_sessions(a, placed_a, 1.5, b, placed_b, 1.5, {}, reason);
  ASSERT_TRUE(link) << reason;
  EXPECT_EQ(a.frames[link->from_frame].time_s, b.frames[link->to_frame].time_s);
  // One camera, seen by both: the identity. Depths are floats of 10 m, and ICP's thinned points of one surface agree
  // to a small part of their 0.2 m voxel.
  EXPECT_LT(link->T_from_to.translation().norm(), 0.01);
  EXPECT_LT(Eigen::AngleAxisd(link->T_from_to.linear()).angle(), 0.002);
}

TEST(SessionGraph, SessionsApartHaveNoLink) {
  const SessionPredictions a = session_of(0, 3, 1.0), b = session_of(7, 3, 1.0);
  const PlacedSession placed_a = placed_session(0, frames_of(a), {}, 0.1),
                      placed_b = placed_session(1, frames_of(b), {}, 0.1);
  std::string reason;
  EXPECT_FALSE(link_sessions(a, placed_a, 1.5, b, placed_b, 1.5, {}, reason));
  EXPECT_EQ(reason, "no frame is shared");
  EXPECT_FALSE(link_sessions(a, placed_a, 99.0, a, placed_a, 99.0, {}, reason));
  EXPECT_EQ(reason, "0 pixels of shared frames are good in both");
}

/// 3 + 4 frames: 2 + 3 consecutive edges, 1 + 2 second-next, one link, a prior for each frame.
TEST(SessionGraph, HasTheEdgesOfThePipeline) {
  const PlacedSession a = placed_session(0, frames_of(session_of(0, 3, 1.0)), {}, 0.3);
  const PlacedSession b = placed_session(1, frames_of(session_of(2, 4, 1.0)), {}, 0.02);
  const SessionLink link{0, 1, 2, 0, Eigen::Isometry3d::Identity(), 0.01, 500, true};
  const PoseGraph graph = session_graph(std::vector{a, b}, std::vector{link}, {}, {});
  EXPECT_EQ(graph.poses.size(), 7u);
  EXPECT_EQ(graph.edges.size(), 2u + 1 + 3 + 2 + 1);
  ASSERT_EQ(graph.priors.size(), 7u);
  EXPECT_EQ(graph.edges.back().from, 2u);
  EXPECT_EQ(graph.edges.back().to, 3u);
  EXPECT_DOUBLE_EQ(graph.edges.back().information(0, 0), 1 / (0.05 * 0.05)) << "no better than 5 cm";
  // A step of a meter: 0.02 * 1 + 0.02 m.
  EXPECT_NEAR(graph.edges.front().information(0, 0), 1 / (0.04 * 0.04), 1e-9);
  EXPECT_DOUBLE_EQ(graph.priors.front().information(0, 0), 1 / (0.3 * 0.3)) << "the registration's RMSE";
  EXPECT_DOUBLE_EQ(graph.priors.back().information(0, 0), 1 / (0.1 * 0.1)) << "no better than 10 cm";
  EXPECT_TRUE(session_graph(std::vector{a, b}, std::vector{link}, {}, {.lidar_priors = false}).priors.empty());
}

/// Odometry of a session's cameras, all off by the same step and turn.
OdometryPoses odometry_of(const PlacedSession& session, double step_m, double turn_deg) {
  OdometryPoses poses;
  for (const Eigen::Isometry3d& pose : session.T_world_camera) {
    Eigen::Isometry3d off = pose;
    off.translate(Eigen::Vector3d(step_m, 0, 0));
    off.rotate(Eigen::AngleAxisd(turn_deg * M_PI / 180.0, Eigen::Vector3d::UnitY()));
    poses.emplace_back(off);
  }
  return poses;
}

TEST(SessionGraph, OdometryHoldsTheSessionsThatAgreeWithIt) {
  const PlacedSession a = placed_session(0, frames_of(session_of(0, 4, 1.0)), {}, 0.2);
  const auto graph_with = [&](const OdometryPoses& odometry, const SessionGraphOptions& options = {}) {
    return session_graph(std::vector{a}, {}, std::span(&odometry, 1), options);
  };
  EXPECT_EQ(graph_with(odometry_of(a, 0.29, 0.0)).priors.size(), 8u);
  EXPECT_EQ(graph_with(odometry_of(a, 0.31, 0.0)).priors.size(), 4u) << "farther than 0.3 m";
  EXPECT_EQ(graph_with(odometry_of(a, 0.0, 1.4)).priors.size(), 8u);
  EXPECT_EQ(graph_with(odometry_of(a, 0.0, 1.6)).priors.size(), 4u) << "more than 1.5 degrees";
  OdometryPoses gaps = odometry_of(a, 0.1, 0.0);
  gaps[2].reset();
  EXPECT_EQ(graph_with(gaps).priors.size(), 7u);
  EXPECT_EQ(graph_with(OdometryPoses(4)).priors.size(), 4u) << "no pose at all";
  EXPECT_TRUE(graph_with(odometry_of(a, 0.1, 0.0), {.lidar_priors = false}).priors.empty());

  // 0.1 m off, odometry pulls with sigma 0.1 m, registration holds with 0.2 m: four fifths of the way, less what the
  // first camera, which is fixed, and VGGT's motions between them hold back.
  const PoseGraphResult found = optimize(graph_with(odometry_of(a, 0.1, 0.0)));
  const Eigen::Vector3d moved_m = found.poses.back().translation() - a.T_world_camera.back().translation();
  EXPECT_GT(moved_m.norm(), 0.02);
  EXPECT_LT(moved_m.norm(), 0.08);
}

/// Without priors, links pull the second session onto the first.
TEST(SessionGraph, OptimizedSessionsMeetAtTheirLink) {
  const PlacedSession a = placed_session(0, frames_of(session_of(0, 5, 1.0)), {}, 0.1);
  const PlacedSession b = placed_session(1, frames_of(session_of(4, 5, 1.0)), at(1.0, {4.5, 0.2, 0}, 0.0), 0.1);
  const SessionLink link{0, 1, 4, 0, Eigen::Isometry3d::Identity(), 0.01, 500, true};
  const PoseGraph graph = session_graph(std::vector{a, b}, std::vector{link}, {}, {.lidar_priors = false});
  const auto moved = with_poses(std::vector{a, b}, optimize(graph).poses);
  for (std::size_t i = 0; i < 5; ++i) {
    // All edges can be satisfied at once: cost zero, to the solver's tolerance.
    EXPECT_LT((moved[1].T_world_camera[i].translation() - Eigen::Vector3d(4.0 + static_cast<double>(i), 0, 0)).norm(),
              1e-5);
  }
}

}  // namespace
}  // namespace cmap
