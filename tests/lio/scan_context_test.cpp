#include "loops/scan_context.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "cmap/core/random_hash.hpp"

namespace cmap {
namespace {

/// Points at random, turned about z.
PointCloud heap(std::uint64_t seed, double yaw_rad = 0.0) {
  PointCloud cloud;
  const Eigen::AngleAxisf turn(static_cast<float>(yaw_rad), Eigen::Vector3f::UnitZ());
  for (std::uint64_t i = 0; i < 600; ++i) {
    const auto random = [&](std::uint64_t k) {
      return static_cast<float>(random_below(1000, 3 * i + k, seed)) / 1000.0F;
    };
    cloud.positions.push_back(
        turn * Eigen::Vector3f(120.0F * random(0) - 60.0F, 120.0F * random(1) - 60.0F, 9.0F * random(2)));
  }
  return cloud;
}

TEST(ScanContext, HoldsTheGreatestHeightOfEachPart) {
  PointCloud cloud;  // rings of 4 m, sectors of 6 degrees
  cloud.positions = {{10.0F, 0.5F, 3.0F}, {10.5F, 0.5F, 5.0F}, {0.5F, -10.0F, 4.0F}, {79.0F, 20.0F, 9.0F}};
  const ScanContext context = scan_context(cloud, 1.0);
  EXPECT_FLOAT_EQ(context.heights(2, 0), 4.0F);
  EXPECT_FLOAT_EQ(context.heights(2, 45), 3.0F);
  EXPECT_FLOAT_EQ(context.heights.sum(), 7.0F);  // the last is beyond 80 m
  EXPECT_FLOAT_EQ(context.ring_key[2], 7.0F / 60.0F);
}

TEST(ScanContext, FindsTurnsOfWholeSectorsExactly) {
  const ScanContext target = scan_context(heap(1), 0.0);
  for (const int sectors : {0, 7, 30, 59}) {
    const double yaw_rad = 2.0 * std::numbers::pi * sectors / ScanContext::kSectors;
    const ScanContextMatch match = best_turn(scan_context(heap(1, -yaw_rad), 0.0), target);
    EXPECT_LT(match.distance, 0.02) << sectors;  // but for points on the border of a part
    EXPECT_NEAR(match.yaw_rad, yaw_rad, 1e-9) << sectors;
  }
}

TEST(ScanContext, OtherPlacesAreFarther) {
  const ScanContext one = scan_context(heap(2), 0.0);
  EXPECT_NEAR(best_turn(one, one).distance, 0.0, 1e-6);
  for (std::uint64_t seed = 3; seed < 8; ++seed) EXPECT_GT(best_turn(one, scan_context(heap(seed), 0.0)).distance, 0.2);
}

TEST(ScanContext, NothingIsFarFromEverything) {
  EXPECT_EQ(best_turn(scan_context(PointCloud{}, 0.0), scan_context(heap(9), 0.0)).distance, 1.0);
}

}  // namespace
}  // namespace cmap
