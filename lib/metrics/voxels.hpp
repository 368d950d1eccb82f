#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/spatial/bvh.hpp"

namespace cmap {

inline constexpr int kCellBits = 5;  ///< a cell has 32 voxels an axis: a surface's sums fit the second-level cache

/// Consecutive slots of a sorted cloud within one cell of 32 x 32 x 32 voxels.
struct CellRun {
  VoxelKey cell;
  std::size_t begin;
  std::size_t end;
};

/// The cloud as runs, ordered by cell and slot. Neighbors on the curve are neighbors in space, so runs are few.
std::vector<CellRun> cell_runs(const PointBlocks& points, const VoxelFrame& frame);

/// Runs of whole cells for one task each: enough points to be worth one, where there are so many.
std::vector<std::span<const CellRun>> cell_tasks(std::span<const CellRun> runs);

/// Sums of the voxels of one cell, in order of first use; every voxel has its place in a table that fits the
/// second-level cache.
template <class Sums>
class CellVoxels {
 public:
  struct Entry {
    VoxelKey key;
    Sums sums;
  };

  CellVoxels() : entry_at_(kVoxels, kFree) {}

  /// Of a voxel of the cell at hand.
  Sums& operator[](const VoxelKey& key) {
    std::uint16_t& entry = entry_at_[place(key)];
    if (entry == kFree) {
      entry = static_cast<std::uint16_t>(entries_.size());
      entries_.push_back({key, {}});
    }
    return entries_[entry].sums;
  }
  std::span<const Entry> entries() const { return entries_; }
  /// Makes room for the next cell.
  void clear() {
    for (const Entry& entry : entries_) entry_at_[place(entry.key)] = kFree;
    entries_.clear();
  }

 private:
  static constexpr std::size_t kVoxels = std::size_t{1} << (3 * kCellBits);
  static constexpr std::uint16_t kFree = 0xffff;
  static_assert(kVoxels < kFree);

  static std::size_t place(const VoxelKey& key) {
    constexpr std::int32_t kMask = (1 << kCellBits) - 1;
    return static_cast<std::size_t>(((key.x & kMask) << kCellBits | (key.y & kMask)) << kCellBits | (key.z & kMask));
  }

  std::vector<std::uint16_t> entry_at_;
  std::vector<Entry> entries_;
};

/// Sums the points of every voxel with add(sums, slot, world, key) and hands the sums to use(result, key, sums); there
/// is a Result for each task, and they are ordered by cell. Cells are independent and sum in the order of slots, so
/// that the results are the same for any number of threads.
template <class Result, class Sums, class AddPoint, class UseVoxel>
std::vector<Result> fold_voxels(const PointBlocks& points, const VoxelFrame& frame, AddPoint add, UseVoxel use) {
  const std::vector<CellRun> runs = cell_runs(points, frame);
  const std::vector<std::span<const CellRun>> tasks = cell_tasks(runs);
  std::vector<Result> results(tasks.size());
  parallel_chunks(tasks.size(), 1, [&](std::size_t i, std::size_t) {
    CellVoxels<Sums> voxels;
    const auto use_cell = [&] {
      for (const auto& [key, sums] : voxels.entries()) use(results[i], key, sums);
      voxels.clear();
    };
    VoxelKey cell = tasks[i].front().cell;
    for (const CellRun& run : tasks[i]) {
      if (run.cell != cell) use_cell();
      cell = run.cell;
      for (std::size_t slot = run.begin; slot < run.end; ++slot) {
        const Eigen::Vector3d world = points.world(slot);
        const VoxelKey key = frame.key(world);
        add(voxels[key], slot, world, key);
      }
    }
    use_cell();
  });
  return results;
}

/// The same where every voxel becomes a result, or none, by finish(key, sums).
template <class Sums, class AddPoint, class Finish>
auto collect_voxels(const PointBlocks& points, const VoxelFrame& frame, AddPoint add, Finish finish) {
  using Result = typename std::invoke_result_t<Finish, const VoxelKey&, const Sums&>::value_type;
  const auto use = [&](std::vector<Result>& results, const VoxelKey& key, const Sums& sums) {
    if (auto result = finish(key, sums)) results.push_back(std::move(*result));
  };
  std::vector<Result> all;
  for (auto& results : fold_voxels<std::vector<Result>, Sums>(points, frame, add, use)) {
    std::ranges::move(results, std::back_inserter(all));
  }
  return all;
}

}  // namespace cmap
