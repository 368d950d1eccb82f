#include "cmap/spatial/k_nearest.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "cmap/core/execution.hpp"
#include "cmap/spatial/nearest.hpp"
#include "core/simd_levels.hpp"
#include "simd/kernels.hpp"
#include "spatial/clouds.hpp"

namespace cmap {
namespace k_nearest_test {

/// The definition: all points by squared distance in double, then by original index.
std::vector<std::uint32_t> brute_force(const PointBlocks& data, const Eigen::Vector3f& query, std::size_t k) {
  struct Entry {
    double sq_dist;
    std::uint32_t index, slot;
  };
  std::vector<Entry> all;
  for (std::uint32_t slot = 0; slot < data.size; ++slot) {
    const Eigen::Vector3d d = query.cast<double>() - data.offset(slot).cast<double>();
    all.push_back({d.x() * d.x() + d.y() * d.y() + d.z() * d.z(), data.original_index[slot], slot});
  }
  std::sort(all.begin(), all.end(), [](const Entry& a, const Entry& b) {
    return a.sq_dist < b.sq_dist || (a.sq_dist == b.sq_dist && a.index < b.index);
  });
  std::vector<std::uint32_t> slots;
  for (std::size_t i = 0; i < k; ++i) slots.push_back(i < all.size() ? all[i].slot : kNoNeighbor);
  return slots;
}

void expect_equals_brute_force(const PointCloud& data, const PointCloud& queries, std::size_t k) {
  const Bvh index(sort_points(data));
  const PointBlocks sorted = sort_points(queries);
  const Array<std::uint32_t> found = find_k_nearest(index, sorted, k);
  ASSERT_EQ(found.size(), queries.size() * k);
  for (std::size_t slot = 0; slot < sorted.size; ++slot) {
    const std::vector<std::uint32_t> of_slot(found.begin() + static_cast<long>(slot * k),
                                             found.begin() + static_cast<long>((slot + 1) * k));
    ASSERT_EQ(of_slot, brute_force(index.points, sorted.offset(slot), k)) << "slot " << slot;
  }
}

TEST(KNearest, EqualsBruteForceAtEverySizeAroundBlocksAndNodes) {
  for (std::size_t n : {1, 2, 15, 16, 17, 255, 256, 257, 4097}) {
    SCOPED_TRACE(n);
    expect_equals_brute_force(test::uniform_cloud(n, 1), test::uniform_cloud(100, 2), 10);
  }
}

TEST(KNearest, EqualsBruteForceOnSurfacesAndTies) {
  expect_equals_brute_force(test::sheet_cloud(3000, 3), test::sheet_cloud(500, 4), 20);
  expect_equals_brute_force(test::grid_cloud(20), test::grid_cloud(12), 7);
  expect_equals_brute_force(test::repeated(test::uniform_cloud(20, 5), 50), test::uniform_cloud(100, 6), 64);
}

TEST(KNearest, TheNearestIsFindNearests) {
  const Bvh index(sort_points(test::sheet_cloud(20000, 7)));
  const PointBlocks queries = sort_points(test::sheet_cloud(5000, 8));
  const Array<std::uint32_t> one = find_k_nearest(index, queries, 1);
  EXPECT_EQ(one, find_nearest(index, queries).slot);
}

TEST(KNearest, TheSameForEveryInstructionSetAndNumberOfThreads) {
  const Bvh index(sort_points(test::sheet_cloud(5000, 9)));
  const Queries queries{index.points, Eigen::Vector3d::Zero()};
  const Array<std::uint32_t> all_threads = find_k_nearest(index, index.points, 20);
  for (SimdLevel level : test::simd_levels_here()) {
    Array<std::uint32_t> found(index.points.size * 20);
    kernels_for(level).k_nearest(index, queries, 20, 0, index.points.blocks.size(), found.data());
    EXPECT_EQ(found, all_threads) << simd_level_name(level);
  }
  const ExecutionScope one({.threads = 1});
  EXPECT_EQ(find_k_nearest(index, index.points, 20), all_threads);
}

TEST(KNearest, RefusesImpossibleNumbers) {
  const Bvh index(sort_points(test::uniform_cloud(10, 1)));
  EXPECT_THROW(find_k_nearest(index, index.points, 0), std::invalid_argument);
  EXPECT_THROW(find_k_nearest(index, index.points, 65), std::invalid_argument);
}

}  // namespace k_nearest_test
}  // namespace cmap
