#include "cmap/sim/scene.hpp"

#include <gtest/gtest.h>

namespace cmap {
namespace {

TEST(Town, GroundIsWhereRaysMeetIt) {
  const Scene town = make_town({});
  for (const SceneRoute& route : town.routes()) {
    for (const Eigen::Vector3d& p : route.points) {
      const auto hit = town.cast(p + Eigen::Vector3d(0, 0, 2.5), -Eigen::Vector3d::UnitZ(), 10.0);
      ASSERT_TRUE(hit);
      EXPECT_NEAR(2.5, hit->distance_m, 0.02);  // the mesh is linear between heights 1 m apart
    }
  }
}

}  // namespace
}  // namespace cmap
