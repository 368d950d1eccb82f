#include "cmap/colorize/surfels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cmap {
namespace surfels_test {

TEST(Surfels, AreAsWideAsTheMapIsCoarseAndFaceOutOfItsPlanes) {
  PointCloud plane;
  plane.origin = {1e6, 2e6, 300};
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      plane.positions.push_back({0.1f * static_cast<float>(i), 0.1f * static_cast<float>(j), 2.0f});
    }
  }
  const Surfels surfels = surfels_of(plane, {12, 0.01, 1.0});
  ASSERT_EQ(surfels.size(), plane.size());
  for (std::size_t slot = 0; slot < surfels.size(); ++slot) {
    EXPECT_NEAR(std::abs(surfels.normals[slot].z()), 1.0f, 1e-4f);
    EXPECT_GE(surfels.radius_m[slot], 0.099f);
    EXPECT_LE(surfels.radius_m[slot], 0.15f) << "corners have two neighbors at 0.1 m";
    const Eigen::Vector3d world = surfels.origin + surfels.positions[slot].cast<double>();
    EXPECT_LT((world - plane.world(surfels.original_index[slot])).norm(), 1e-6);
  }
  for (std::size_t g = 0; g < surfels.groups.size(); ++g) {
    for (std::size_t i = g * Surfels::kGroup; i < std::min(surfels.size(), (g + 1) * Surfels::kGroup); ++i) {
      EXPECT_LE((surfels.positions[i] - surfels.groups[g].center).norm(), surfels.groups[g].radius_m);
    }
  }
  EXPECT_NEAR(spacing_of(plane), 0.1, 1e-5);
}

TEST(Surfels, OfFewPointsHaveNoPlane) {
  PointCloud few;
  few.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Surfels surfels = surfels_of(few, {12, 0.05, 0.5});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(surfels.normals[i].isZero());
    EXPECT_FLOAT_EQ(surfels.radius_m[i], 0.5f);
  }
  few.positions.resize(1);
  EXPECT_EQ(spacing_of(few), 0.0);
  EXPECT_FLOAT_EQ(surfels_of(few, {12, 0.05, 0.5}).radius_m[0], 0.05f);
}

}  // namespace surfels_test
}  // namespace cmap
