#include <gtest/gtest.h>

#include "posegraph/stage.hpp"
#include "recon/session_testing.hpp"

namespace cmap {
namespace posegraph_stage_test {

using test::at;
using test::session_of;

/// Two sessions in a row, the second 0.3 m off, and a link that says so.
struct Row {
  std::vector<PlacedSession> sessions{
      placed_session(0, frames_of(session_of(0, 5, 1.0)), {}, 0.1),
      placed_session(1, frames_of(session_of(4, 5, 1.0)), at(1.0, {4.3, 0, 0}, 0.0), 0.1)};
  std::vector<SessionLink> links{{0, 1, 4, 0, Eigen::Isometry3d::Identity(), 0.01, 500, true}};
};

TEST(PoseGraphStage, TellsWhatItHasDone) {
  const Row row;
  SessionGraphOptions options;
  options.lidar_priors = false;
  const PoseGraphOut out = run_pose_graph({row.sessions, row.links, {}}, options);
  EXPECT_TRUE(out.converged);
  EXPECT_TRUE(out.warnings.empty());
  // One link, 0.3 m off, with sigma 0.05 m and Cauchy's kernel of width 1.
  EXPECT_NEAR(out.summary.cost_before, std::log1p(36.0), 1e-9);
  EXPECT_LT(out.summary.cost_after, 1e-6) << "all edges can hold";
  EXPECT_NEAR(out.summary.largest_correction_m, 0.3, 1e-3);
  EXPECT_NEAR(out.sessions[1].T_world_camera[0].translation().x(), 4.0, 1e-3);
  EXPECT_EQ(out.sessions[0].T_world_camera[0].translation(), Eigen::Vector3d::Zero()) << "the first node is fixed";
}

TEST(PoseGraphStage, LeavesAloneWhatAgrees) {
  const Row row;
  const PoseGraphOut out = run_pose_graph({row.sessions, {}, {}}, {});
  EXPECT_NEAR(out.summary.cost_before, 0.0, 1e-12);
  EXPECT_NEAR(out.summary.largest_correction_m, 0.0, 1e-9);
}

/// What is certain pulls what is not.
TEST(PoseGraphStage, SigmasDecideWhoYields) {
  const Row row;
  const auto end_x_m = [&](double prior_sigma_m) {
    SessionGraphOptions options;
    options.prior_sigma_m = prior_sigma_m;
    return run_pose_graph({row.sessions, row.links, {}}, options).sessions[1].T_world_camera[4].translation().x();
  };
  EXPECT_LT(end_x_m(1.0), end_x_m(0.1) - 0.05) << "weaker priors, a stronger link";
}

}  // namespace posegraph_stage_test
}  // namespace cmap
