#include "voxels.hpp"

#include <array>
#include <map>
#include <set>

#include "cmap/core/execution.hpp"
#include "metrics/map_pairs.hpp"

namespace cmap {
namespace voxels_test {

using Key = std::array<std::int32_t, 3>;

Key array_of(const VoxelKey& key) { return {key.x, key.y, key.z}; }

/// More points than one chunk of the loops, over cells on all sides of zero.
Bvh sorted_sheet() {
  PointCloud cloud = test::sheet_cloud(150000, 1, 60.0f);
  for (Eigen::Vector3f& p : cloud.positions) p -= Eigen::Vector3f(30, 30, 30);
  return Bvh(sort_points(cloud));
}

Box3d box_of(const PointBlocks& points) {
  Box3d box{points.world(0), points.world(0)};
  for (std::size_t slot = 0; slot < points.size; ++slot) {
    box.min = box.min.cwiseMin(points.world(slot));
    box.max = box.max.cwiseMax(points.world(slot));
  }
  return box;
}

TEST(CellRuns, HoldEverySlotOnceInItsCell) {
  const Bvh cloud = sorted_sheet();
  const PointBlocks& points = cloud.points;
  const VoxelFrame frame(box_of(points), 0.25);
  std::vector<int> seen(points.size, 0);
  for (const CellRun& run : cell_runs(cloud, frame)) {
    ASSERT_LT(run.begin, run.end);
    for (std::size_t slot = run.begin; slot < run.end; ++slot) {
      const VoxelKey key = frame.key(points.world(slot));
      // Keys count from the box's lowest corner: 32 voxels a cell.
      EXPECT_EQ(array_of(run.cell), (Key{key.x / 32, key.y / 32, key.z / 32}));
      ++seen[slot];
    }
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(points.size));
}

TEST(CellRuns, OfOneCellFollowEachOther) {
  const Bvh cloud = sorted_sheet();
  const PointBlocks& points = cloud.points;
  const std::vector<CellRun> runs = cell_runs(cloud, VoxelFrame(box_of(points), 0.25));
  std::set<Key> closed;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    if (runs[i].cell == runs[i - 1].cell) {
      EXPECT_LE(runs[i - 1].end, runs[i].begin);
    } else {
      EXPECT_TRUE(closed.insert(array_of(runs[i - 1].cell)).second);
    }
  }
  EXPECT_GT(closed.size(), 10U);
}

struct CountedVoxel {
  VoxelKey key;
  std::uint64_t n;
};

auto count_points(const Bvh& cloud, const VoxelFrame& frame, std::uint64_t min_points) {
  return collect_voxels<std::uint64_t>(
      cloud, frame, [](std::uint64_t& n, std::size_t) { ++n; },
      [&](const VoxelKey& key, std::uint64_t n) -> std::optional<CountedVoxel> {
        if (n < min_points) return std::nullopt;
        return CountedVoxel{key, n};
      });
}

TEST(CollectVoxels, CountsLikeAMap) {
  const Bvh cloud = sorted_sheet();
  const PointBlocks& points = cloud.points;
  for (double voxel_m : {0.1, 1.0, 200.0}) {
    const VoxelFrame frame(box_of(points), voxel_m);
    std::map<Key, std::uint64_t> expected;
    for (std::size_t slot = 0; slot < points.size; ++slot) ++expected[array_of(frame.key(points.world(slot)))];
    const auto found = count_points(cloud, frame, 1);
    EXPECT_EQ(found.size(), expected.size());
    for (const CountedVoxel& voxel : found) EXPECT_EQ(voxel.n, expected[array_of(voxel.key)]);

    const auto full = count_points(cloud, frame, 40);
    const auto is_full = [](const auto& entry) { return entry.second >= 40; };
    EXPECT_EQ(static_cast<std::ptrdiff_t>(full.size()), std::ranges::count_if(expected, is_full));
    for (const CountedVoxel& voxel : full) EXPECT_GE(voxel.n, 40U);
  }
}

TEST(CollectVoxels, InTheSameOrderForAnyNumberOfThreads) {
  const Bvh cloud = sorted_sheet();
  const PointBlocks& points = cloud.points;
  const VoxelFrame frame(box_of(points), 0.25);
  const auto many = count_points(cloud, frame, 1);
  const ExecutionScope limit({.threads = 1});
  const auto one = count_points(cloud, frame, 1);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].key, many[i].key);
}

}  // namespace voxels_test
}  // namespace cmap
