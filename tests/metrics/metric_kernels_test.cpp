// Every instruction set must give the bits of the plain kernels, and these what their formulas say.

#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "color_sums.hpp"
#include "core/simd_levels.hpp"
#include "grid_places.hpp"
#include "phased_frame.hpp"

namespace cmap {
namespace metric_kernels_test {

class MetricKernels : public testing::TestWithParam<SimdLevel> {
 protected:
  const cmap::MetricKernels& level() const { return metric_kernels_for(GetParam()); }
};

struct PointsInBox {
  PointBlocks points;
  Box3d box;
};

/// A block of points far from the world's origin, some on faces of voxels and halves of them.
PointsInBox points_on_and_off_faces() {
  PointBlock block;
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    block.x[i] = -3.0f + 0.25f * static_cast<float>(i);
    block.y[i] = -2.0f + 0.37f * static_cast<float>(i);
    block.z[i] = 5.0f - 0.5f * static_cast<float>(i);
  }
  PointBlocks points;
  points.origin = {448'000.25, -5'411'000.5, 0.0};
  points.blocks.push_back(block);
  points.size = kBlockSize;
  const Eigen::Vector3d half(20, 20, 20);
  return {points, {points.origin - half, points.origin + half}};
}

/// floor(m x / voxel) - m floor(x / voxel).
std::int32_t part_of(double x, double voxel_m, int m) {
  return static_cast<std::int32_t>(std::floor(m * x / voxel_m) - m * std::floor(x / voxel_m));
}

TEST_P(MetricKernels, PlacesAreThoseOfTheFrame) {
  const auto [points, box] = points_on_and_off_faces();
  for (const int m : {1, 2, 3}) {
    const VoxelFrame frame(box, 0.5);
    GridPlaces places;
    level().grid_places(part_grid(points, frame, m, 4), points.blocks[0], places);
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      const Eigen::Vector3d world = points.world(i);
      const VoxelKey key = frame.key(world);
      ASSERT_EQ((VoxelKey{places.x[i], places.y[i], places.z[i]}), key);
      const std::int32_t x = key.x % 4 * m + part_of(world.x(), 0.5, m), y = key.y % 4 * m + part_of(world.y(), 0.5, m),
                         z = key.z % 4 * m + part_of(world.z(), 0.5, m);
      ASSERT_EQ(places.in_cell[i], (x * 4 * m + y) * 4 * m + z);
    }
  }
}

TEST_P(MetricKernels, OffsetsAreThoseOfThePlainOnes) {
  const auto [points, box] = points_on_and_off_faces();
  for (const double voxel_m : {0.3, 0.5, 3.9}) {
    const PartGrid grid = part_grid(points, VoxelFrame(box, voxel_m), 1, 4);
    GridPlaces places;
    metric_kernels_for(SimdLevel::kPlain).grid_places(grid, points.blocks[0], places);
    OffsetLanes found, plain;
    level().offsets(grid, 0x1p30, points.blocks[0], places, found);
    metric_kernels_for(SimdLevel::kPlain).offsets(grid, 0x1p30, points.blocks[0], places, plain);
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      ASSERT_EQ((std::array{found.x[i], found.y[i], found.z[i]}), (std::array{plain.x[i], plain.y[i], plain.z[i]}));
      const double index = grid.first[0] + places.x[i];
      ASSERT_EQ(found.x[i], std::max(0.0, std::floor((points.world(i).x() - index * voxel_m) * 0x1p30 + 0.5)));
    }
  }
}

/// Three rows of voxels whose y and z are drawn, sorted, and whose distances are whole, so that sums are exact.
struct DrawnRows {
  explicit DrawnRows(std::mt19937& random) {
    std::uniform_int_distribution<int> at(-9, 9);
    for (int row = 0; row < 3; ++row) {
      std::vector<std::array<int, 2>> row_voxels(static_cast<std::size_t>(11 + 7 * row));
      for (auto& [row_y, row_z] : row_voxels) row_y = at(random), row_z = at(random);
      std::ranges::sort(row_voxels);
      for (const auto& [row_y, row_z] : row_voxels) add(row_y, row_z, at(random) + 20);
      for (std::size_t i = 0; i < RowsOfVoxels::kAtOnce; ++i) add(std::numeric_limits<double>::infinity(), 0, 0);
    }
  }
  void add(double at_y, double at_z, double at_distance_m) {
    y.push_back(at_y);
    z.push_back(at_z);
    distance_m.push_back(at_distance_m);
  }
  RowsOfVoxels rows() const { return {y.data(), z.data(), distance_m.data()}; }

  std::vector<double> y, z, distance_m;
};

TEST_P(MetricKernels, NearSumsAreThoseOfALoop) {
  std::mt19937 random(3);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const DrawnRows drawn(random);
    const std::size_t second_row = 11 + RowsOfVoxels::kAtOnce, center = second_row + random() % 18;
    // Of the first row a part of which no voxel before lies near in y, of the second all.
    std::size_t begin = 0;
    while (begin < 11 && drawn.y[begin] < drawn.y[center] - 4) ++begin;
    const Stretch stretches[]{{begin, 11}, {second_row, second_row + 18}};
    NearSums expected{};
    for (const Stretch& stretch : stretches) {
      for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
        if (std::abs(drawn.y[i] - drawn.y[center]) > 4 || std::abs(drawn.z[i] - drawn.z[center]) > 4) continue;
        const double difference = drawn.distance_m[i] - drawn.distance_m[center];
        expected.n += 1;
        expected.sum += difference;
        expected.sum_sq += difference * difference;
      }
    }
    const NearSums found = level().near_sums(drawn.rows(), stretches, 2, center, 4.0);
    ASSERT_GE(found.n, 1.0);
    ASSERT_EQ((std::array{found.n, found.sum, found.sum_sq}), (std::array{expected.n, expected.sum, expected.sum_sq}));
  }
}

/// Colors about a center, spread on some channels only, so that covariances of rank 0 to 3 occur.
NarrowColorSums random_colors(std::mt19937& random, int rank, int n) {
  NarrowColorSums sums;
  std::uniform_int_distribution<std::uint32_t> center(40, 200), spread(0, 30);
  const std::array<std::uint32_t, 3> at{center(random), center(random), center(random)};
  for (int i = 0; i < n; ++i) {
    std::array<std::uint32_t, 3> color = at;
    for (int channel = 0; channel < rank; ++channel) color[static_cast<std::size_t>(channel)] += spread(random);
    sums.add(color);
  }
  return sums;
}

struct RandomPairs {
  ColorPairLanes lanes{};
  std::array<double, ColorPairLanes::kLanes> expected{};
};

/// Expected is what the general formula makes of the same sums.
RandomPairs random_pairs(std::mt19937& random) {
  RandomPairs pairs;
  for (std::size_t i = 0; i < ColorPairLanes::kLanes; ++i) {
    const int rank = static_cast<int>(i % 4);
    const NarrowColorSums a = random_colors(random, rank, 2 + 40 * static_cast<int>(i));
    const NarrowColorSums b = random_colors(random, (rank + static_cast<int>(i / 8)) % 4, 100);
    for (std::size_t word = 0; word < ColorPairLanes::kWords; ++word) {
      pairs.lanes.reference[word][i] = a.words()[word];
      pairs.lanes.estimate[word][i] = b.words()[word];
    }
    pairs.expected[i] = wasserstein_distance(WideColorSums(a).gaussian(1.0), WideColorSums(b).gaussian(1.0));
  }
  return pairs;
}

TEST_P(MetricKernels, ColorDistancesAreThoseOfGaussians) {
  std::mt19937 random(1);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const RandomPairs pairs = random_pairs(random);
    std::array<double, ColorPairLanes::kLanes> found{}, plain{};
    level().color_distances(pairs.lanes, found.data());
    metric_kernels_for(SimdLevel::kPlain).color_distances(pairs.lanes, plain.data());
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(found[i]), std::bit_cast<std::uint64_t>(plain[i]));
      // Both round sums of up to 1e4 levels squared, of which the distance is the root of a small rest.
      ASSERT_NEAR(found[i] * found[i], pairs.expected[i] * pairs.expected[i], 1e-10);
    }
  }
}

TEST_P(MetricKernels, NoLaneChangesItsNeighbors) {
  std::mt19937 random(2);
  RandomPairs pairs = random_pairs(random);
  std::array<double, ColorPairLanes::kLanes> together{}, alone{};
  level().color_distances(pairs.lanes, together.data());
  for (std::size_t word = 0; word < ColorPairLanes::kWords; ++word) {
    for (std::size_t i = 1; i < ColorPairLanes::kLanes; ++i) pairs.lanes.reference[word][i] = 0;
  }
  level().color_distances(pairs.lanes, alone.data());
  EXPECT_EQ(together[0], alone[0]);
}

TEST_P(MetricKernels, OneColorIsAtNoDistanceFromItself) {
  ColorPairLanes pairs{};
  const auto put = [](std::uint32_t(&words)[ColorPairLanes::kWords][ColorPairLanes::kLanes], std::size_t lane, int n) {
    NarrowColorSums sums;
    for (int i = 0; i < n; ++i) sums.add({255, 31, 7});
    for (std::size_t word = 0; word < ColorPairLanes::kWords; ++word) words[word][lane] = sums.words()[word];
  };
  for (std::size_t i = 0; i < ColorPairLanes::kLanes; ++i) {
    put(pairs.reference, i, 3 + static_cast<int>(i));
    put(pairs.estimate, i, 49 * static_cast<int>(i + 1));
  }
  std::array<double, ColorPairLanes::kLanes> found{};
  level().color_distances(pairs, found.data());
  for (const double distance : found) EXPECT_EQ(distance, 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, MetricKernels, testing::ValuesIn(test::simd_levels_here()),
                         [](const auto& level) { return std::string(simd_level_name(level.param)); });

}  // namespace metric_kernels_test
}  // namespace cmap
