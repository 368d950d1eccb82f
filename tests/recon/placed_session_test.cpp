#include "cmap/recon/placed_session.hpp"

#include <gtest/gtest.h>

#include "recon/session_testing.hpp"

namespace cmap {
namespace placed_session_test {

TEST(PlacedSession, FramesOfASessionAreWhereTheSimilarityPutsThem) {
  const SessionPredictions session = test::session_of(0, 3, 2.0);
  const PlacedSession placed = placed_session(4, frames_of(session), test::at(2.0, {1, 2, 3}, 0.0), 0.1);
  EXPECT_EQ(placed.index, 4u);
  EXPECT_EQ(placed.time_s, (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_LT((placed.T_world_camera[2].translation() - Eigen::Vector3d(3, 2, 3)).norm(), 1e-12) << "2 m along x";
}

}  // namespace placed_session_test
}  // namespace cmap
