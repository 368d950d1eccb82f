#include "cmap/spatial/point_blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "cmap/core/execution.hpp"
#include "cmap/spatial/radix_sort.hpp"
#include "spatial/clouds.hpp"

namespace cmap {
namespace point_blocks_test {

TEST(SortPoints, IsAPermutationWithThePositionsInPlace) {
  for (std::size_t n : {1, 16, 17, 5000}) {
    const PointCloud cloud = test::uniform_cloud(n, 1);
    const PointBlocks sorted = sort_points(cloud);
    ASSERT_EQ(sorted.size, n);
    std::vector<std::uint32_t> indices(sorted.original_index.begin(),
                                       sorted.original_index.begin() + static_cast<long>(n));
    for (std::size_t slot = 0; slot < n; ++slot) EXPECT_EQ(sorted.offset(slot), cloud.positions[indices[slot]]);
    std::sort(indices.begin(), indices.end());
    for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(indices[i], i);
  }
}

TEST(SortPoints, LastBlockRepeatsTheLastPoint) {
  const PointBlocks sorted = sort_points(test::uniform_cloud(18, 2));
  for (std::size_t slot = 18; slot < 32; ++slot) {
    EXPECT_EQ(sorted.offset(slot), sorted.offset(17));
    EXPECT_EQ(sorted.original_index[slot], sorted.original_index[17]);
  }
}

/// Mean distance between points that follow each other: what a curve through space keeps small.
double mean_step(const PointBlocks& points) {
  double sum = 0.0;
  for (std::size_t slot = 1; slot < points.size; ++slot) sum += (points.offset(slot) - points.offset(slot - 1)).norm();
  return sum / static_cast<double>(points.size - 1);
}

TEST(SortPoints, NeighborsOnTheCurveAreNeighborsInSpace) {
  // 20,000 points in a unit cube are 0.037 m apart; a Hilbert curve's mean step stays below twice that.
  EXPECT_LT(mean_step(sort_points(test::uniform_cloud(20000, 3, 1.0f))), 0.074);
}

TEST(SortPoints, AFarOutlierDoesNotSpoilTheOrder) {
  PointCloud cloud = test::uniform_cloud(20000, 4, 1.0f);
  cloud.positions.front().x() += 1e6f;
  PointBlocks sorted = sort_points(cloud);
  double sum = 0.0;
  for (std::size_t slot = 1; slot < sorted.size; ++slot) {
    const double step = (sorted.offset(slot) - sorted.offset(slot - 1)).norm();
    if (step < 10.0) sum += step;
  }
  EXPECT_LT(sum / 20000.0, 0.074);
}

TEST(SortPoints, DuplicatesKeepTheirOrder) {
  const PointBlocks sorted = sort_points(test::repeated(test::uniform_cloud(1, 5), 5000));
  EXPECT_TRUE(std::is_sorted(sorted.original_index.begin(), sorted.original_index.end()));
}

TEST(SortPoints, SameForAnyNumberOfThreads) {
  const PointCloud cloud = test::sheet_cloud(300000, 6);
  PointBlocks one;
  {
    const ExecutionScope limit({.threads = 1});
    one = sort_points(cloud);
  }
  EXPECT_EQ(sort_points(cloud).original_index, one.original_index);
}

TEST(SortPoints, EmptyCloudIsRefused) { EXPECT_THROW(sort_points(PointCloud{}), std::invalid_argument); }

TEST(SortColors, AreThePointsOwnInUnitsOf255) {
  PointCloud cloud = test::uniform_cloud(40, 7);
  Array<Rgb16> colors(40);
  for (std::uint16_t i = 0; i < 40; ++i) colors[i] = {static_cast<std::uint16_t>(257 * i), 0, 65535};
  cloud.colors = colors;
  const PointBlocks sorted = sort_points(cloud);
  const Array<ColorBlock> sorted_colors = sort_colors(cloud, sorted);
  for (std::size_t slot = 0; slot < 40; ++slot) {
    const Eigen::Vector3f expected(static_cast<float>(sorted.original_index[slot]), 0.0f, 255.0f);
    EXPECT_EQ(color_at(sorted_colors, slot), expected);
  }
}

TEST(RadixSort, EqualsStableSort) {
  std::mt19937_64 random(8);
  Array<std::uint64_t> values(3000000);
  for (std::uint64_t& v : values) v = random() >> 20;
  Array<std::uint64_t> expected = values;
  std::stable_sort(expected.begin(), expected.end(), [](auto a, auto b) { return a >> 11 < b >> 11; });
  Array<std::uint64_t> scratch;
  radix_sort(values, scratch, 11, 44);
  EXPECT_EQ(values, expected);
}

}  // namespace point_blocks_test
}  // namespace cmap
