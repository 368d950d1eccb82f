#include "cmap/recon/session_graph.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "recon/session_testing.hpp"

namespace cmap {
namespace session_graph_test {

using test::at;
using test::session_of;

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

}  // namespace session_graph_test
}  // namespace cmap
