#include "thinning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cmap/core/execution.hpp"
#include "spatial/clouds.hpp"

namespace cmap {
namespace thinning_test {

using ::testing::ElementsAre;

TEST(EvenlySpreadSlots, AllOfAMapThatIsSmallEnough) {
  EXPECT_THAT(evenly_spread_slots(sort_points(test::uniform_cloud(3, 1)), 3), ElementsAre(0, 1, 2));
}

TEST(EvenlySpreadSlots, AsManyAsWantedAscending) {
  const PointBlocks points = sort_points(test::sheet_cloud(50'003, 1));
  const Array<std::uint32_t> slots = evenly_spread_slots(points, 7'000);
  EXPECT_NEAR(static_cast<double>(slots.size()), 7'000.0, 16.0);  // the last block has fewer points to give
  EXPECT_TRUE(std::ranges::is_sorted(slots));
  EXPECT_EQ(std::ranges::adjacent_find(slots), slots.end()) << "no point twice";
  EXPECT_LT(slots.back(), points.size);
}

/// A square of 10 m with a quarter sampled 28 times as densely: thinned, a quarter of the points is there.
TEST(EvenlySpreadSlots, DenseSurfacesGiveNoMoreThanTheirShare) {
  PointCloud cloud;
  std::mt19937_64 random(3);
  for (int i = 0; i < 207'000; ++i) {
    const bool dense = i % 23 < 20;
    const double side = dense ? 5.0 : 10.0;
    const double x = side * test::uniform(random), y = side * test::uniform(random);
    cloud.positions.push_back({static_cast<float>(x), static_cast<float>(y), 0.0f});
  }
  const PointBlocks points = sort_points(cloud);
  const Array<std::uint32_t> slots = evenly_spread_slots(points, 3'000);
  const auto in_dense_quarter = std::ranges::count_if(
      slots, [&](std::uint32_t slot) { return points.world(slot).x() < 5.0 && points.world(slot).y() < 5.0; });
  // Boxes of sixteen points are some tens of percent off the surface; by points the share would be 0.9.
  EXPECT_NEAR(static_cast<double>(in_dense_quarter) / static_cast<double>(slots.size()), 0.25, 0.1);
}

TEST(EvenlySpreadSlots, StrayPointsTakeNotTheRoomOfTheMap) {
  PointCloud cloud = test::sheet_cloud(60'000, 4);
  std::mt19937_64 random(5);
  for (int i = 0; i < 300; ++i) cloud.positions.push_back(test::uniform_point(random, 1000.0f));
  const PointBlocks points = sort_points(cloud);
  const Array<std::uint32_t> slots = evenly_spread_slots(points, 6'000);
  const auto strays =
      std::ranges::count_if(slots, [&](std::uint32_t slot) { return points.world(slot).norm() > 100.0; });
  EXPECT_GT(strays, 0);
  EXPECT_LE(strays, 300);
}

TEST(EvenlySpreadSlots, PointsOnOneSpotAndOnALine) {
  PointCloud spot;
  spot.positions.assign(1'000, {1.0f, 2.0f, 3.0f});
  EXPECT_NEAR(static_cast<double>(evenly_spread_slots(sort_points(spot), 100).size()), 100.0, 2.0);
  PointCloud line;
  for (int i = 0; i < 1'000; ++i) line.positions.push_back({static_cast<float>(i), 0.0f, 0.0f});
  EXPECT_NEAR(static_cast<double>(evenly_spread_slots(sort_points(line), 100).size()), 100.0, 2.0);
}

TEST(EvenlySpreadSlots, TheSameForAnyNumberOfThreads) {
  const PointBlocks points = sort_points(test::sheet_cloud(200'000, 6));
  const Array<std::uint32_t> all = evenly_spread_slots(points, 10'000);
  const ExecutionScope one({.threads = 1});
  EXPECT_EQ(evenly_spread_slots(points, 10'000), all);
}

}  // namespace thinning_test
}  // namespace cmap
