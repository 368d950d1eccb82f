// Every instruction set must give the bits of the plain kernels.

#include "core/simd_levels.hpp"

#include <gtest/gtest.h>

#include "simd/kernels.hpp"
#include "spatial/clouds.hpp"

namespace cmap {
namespace simd_levels_test {

class SimdLevels : public testing::TestWithParam<SimdLevel> {
 protected:
  const Kernels& level() const { return kernels_for(GetParam()); }
  const Kernels& plain() const { return kernels_for(SimdLevel::kPlain); }
};

TEST_P(SimdLevels, HilbertKeys) {
  const PointCloud cloud = test::uniform_cloud(1000, 1, 2100.0f);  // beyond the last cell too
  const CurveGrid grid{{10.0f, -5.0f, 0.0f}, {1.0f, 0.9f, 1.1f}};
  std::vector<std::uint64_t> keys(1000), expected(1000);
  level().hilbert_keys(cloud.positions.data(), 1000, grid, 7, keys.data());
  plain().hilbert_keys(cloud.positions.data(), 1000, grid, 7, expected.data());
  EXPECT_EQ(keys, expected);
}

TEST_P(SimdLevels, Nearest) {
  const Bvh index(sort_points(test::repeated(test::sheet_cloud(20000, 2), 2)));
  const PointBlocks points = sort_points(test::sheet_cloud(30001, 3));
  for (double shift : {0.0, 12345.6789}) {
    const Queries queries{points, Eigen::Vector3d(shift, 0, 0)};
    NearestField found{Array<std::uint32_t>(points.size), Array<double>(points.size)};
    NearestField expected = found;
    level().nearest(index, queries, 0, points.blocks.size(), found);
    plain().nearest(index, queries, 0, points.blocks.size(), expected);
    EXPECT_EQ(found.slot, expected.slot);
    EXPECT_EQ(found.sq_dist, expected.sq_dist);
  }
}

TEST_P(SimdLevels, MostSimilarColor) {
  PointCloud data = test::sheet_cloud(20000, 4);
  PointCloud query_cloud = test::sheet_cloud(16000, 5);
  test::paint(data, 6);
  test::paint(query_cloud, 7);
  const Bvh index(sort_points(data));
  const Array<ColorBlock> colors = sort_colors(data, index.points);
  const BoxLevels boxes = color_boxes(colors);
  const PointBlocks points = sort_points(query_cloud);
  const Array<ColorBlock> query_colors = sort_colors(query_cloud, points);
  const NearestField nearest = find_nearest(index, points);
  const Queries queries{points, Eigen::Vector3d::Zero()};
  const ColoredIndex target{index, colors, boxes};
  const ColorQueries colored{queries, query_colors, nearest};
  Array<float> best(points.size), expected(points.size);
  const ColorSearch search{0.3, 100.0f, 3000.0f, 1000.0};
  level().most_similar_color(target, colored, search, 0, points.blocks.size(), best);
  plain().most_similar_color(target, colored, search, 0, points.blocks.size(), expected);
  EXPECT_EQ(best, expected);
}

TEST_P(SimdLevels, NeighborhoodShapes) {
  const Bvh index(sort_points(test::sheet_cloud(20001, 8)));
  const std::size_t n = index.points.size;
  NeighborhoodShape found{Array<std::uint32_t>(n), Array<double>(n), Array<std::uint8_t>(n)};
  NeighborhoodShape expected = found;
  level().neighborhood_shapes(index, 0.6, 0.1, 0, index.points.blocks.size(), found);
  plain().neighborhood_shapes(index, 0.6, 0.1, 0, index.points.blocks.size(), expected);
  EXPECT_EQ(found.n_neighbors, expected.n_neighbors);
  EXPECT_EQ(found.is_flat, expected.is_flat);
  for (std::size_t i = 0; i < n; ++i) {
    // NaN equals nothing, so the bits are compared.
    ASSERT_EQ(std::bit_cast<std::uint64_t>(found.covariance_det[i]),
              std::bit_cast<std::uint64_t>(expected.covariance_det[i]));
  }
}

INSTANTIATE_TEST_SUITE_P(All, SimdLevels, testing::ValuesIn(test::simd_levels_here()),
                         [](const auto& level) { return std::string(simd_level_name(level.param)); });

}  // namespace simd_levels_test
}  // namespace cmap
