#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/spatial/bvh.hpp"
#include "grid_places.hpp"

namespace cmap {

inline constexpr int kCellBits = 5;  ///< a cell has 32 voxels an axis: a surface's sums fit the second-level cache

/// Consecutive slots of a sorted cloud within one cell of 2^bits voxels an axis.
struct CellRun {
  VoxelKey cell;
  std::uint32_t begin;
  std::uint32_t end;
};

/// The cloud as runs, ordered by cell and slot. Neighbors on the curve are neighbors in space, so runs are few; what
/// lies below a box within one cell is not looked at.
std::vector<CellRun> cell_runs(const Bvh& cloud, const VoxelFrame& frame, int cell_bits = kCellBits);

/// Points of the least work that is worth a task.
inline constexpr std::size_t kTaskPoints = std::size_t{1} << 16;

/// Items in their order, cut into one span a task: each of enough points to be worth one, where there are so many, and
/// ended only where may_end(i) allows it.
template <class Item, class PointsOf, class MayEnd>
std::vector<std::span<const Item>> point_tasks(std::span<const Item> items, PointsOf points_of, MayEnd may_end) {
  std::vector<std::span<const Item>> tasks;
  std::size_t begin = 0, n_points = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const bool is_last = i + 1 == items.size();
    n_points += points_of(items[i]);
    if (!is_last && (n_points < kTaskPoints || !may_end(i))) continue;
    tasks.push_back(items.subspan(begin, i + 1 - begin));
    begin = i + 1;
    n_points = 0;
  }
  return tasks;
}

/// Runs of whole cells for one task each: enough points to be worth one, where there are so many.
std::vector<std::span<const CellRun>> cell_tasks(std::span<const CellRun> runs);

/// A place within a cell, counted from its corner.
using LocalKey = std::array<std::int32_t, 3>;

/// Sums of the places of one cell, in order of first use; every place has its entry in a table that fits the
/// second-level cache.
template <class Sums>
class LocalGrid {
 public:
  struct Entry {
    LocalKey key;
    Sums sums;
  };

  /// Of `edge` places an axis.
  explicit LocalGrid(std::int32_t edge)
      : edge_(edge), entry_at_(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge * edge), kFree) {}

  Sums& operator[](const LocalKey& key) {
    std::uint32_t& entry = entry_at_[place(key)];
    if (entry == kFree) [[unlikely]]
      entry = add_entry(key);
    return entries_[entry].sums;
  }
  /// By a place's number, x slowest.
  Sums& at_place(std::int32_t place) {
    std::uint32_t& entry = entry_at_[static_cast<std::size_t>(place)];
    if (entry == kFree) [[unlikely]]
      entry = add_entry({place / (edge_ * edge_), place / edge_ % edge_, place % edge_});
    return entries_[entry].sums;
  }
  std::span<const Entry> entries() const { return entries_; }
  /// Makes room for the next cell.
  void clear() {
    for (const Entry& entry : entries_) entry_at_[place(entry.key)] = kFree;
    entries_.clear();
  }

 private:
  static constexpr std::uint32_t kFree = ~0u;

  [[gnu::noinline]] std::uint32_t add_entry(const LocalKey& key) {
    entries_.push_back({key, {}});
    return static_cast<std::uint32_t>(entries_.size() - 1);
  }
  std::size_t place(const LocalKey& key) const {
    return static_cast<std::size_t>((key[0] * edge_ + key[1]) * edge_ + key[2]);
  }

  std::int32_t edge_;
  std::vector<std::uint32_t> entry_at_;
  std::vector<Entry> entries_;
};

/// Sums the points of every voxel with add(sums, slot) and hands the sums to use(result, key, sums); there
/// is a Result for each task, and they are ordered by cell. Cells are independent and sum in the order of slots, so
/// that the results are the same for any number of threads.
template <class Result, class Sums, class AddPoint, class UseVoxel>
std::vector<Result> fold_voxels(const Bvh& cloud, const VoxelFrame& frame, AddPoint add, UseVoxel use) {
  constexpr std::int32_t kEdge = 1 << kCellBits;
  const std::vector<CellRun> runs = cell_runs(cloud, frame);
  const std::vector<std::span<const CellRun>> tasks = cell_tasks(runs);
  const PartGrid grid = part_grid(cloud.points, frame, 1, kEdge);
  std::vector<Result> results(tasks.size());
  parallel_chunks(tasks.size(), 1, [&](std::size_t i, std::size_t) {
    LocalGrid<Sums> voxels(kEdge);
    VoxelKey cell = tasks[i].front().cell;
    const auto use_cell = [&] {
      for (const auto& [at, sums] : voxels.entries()) {
        use(results[i], VoxelKey{cell.x * kEdge + at[0], cell.y * kEdge + at[1], cell.z * kEdge + at[2]}, sums);
      }
      voxels.clear();
    };
    for (const CellRun& run : tasks[i]) {
      if (run.cell != cell) use_cell();
      cell = run.cell;
      for_places(cloud.points, grid, run.begin, run.end,
                 [&](std::size_t slot, const VoxelKey&, std::int32_t place) { add(voxels.at_place(place), slot); });
    }
    use_cell();
  });
  return results;
}

/// The same where every voxel becomes a result, or none, by finish(key, sums).
template <class Sums, class AddPoint, class Finish>
auto collect_voxels(const Bvh& cloud, const VoxelFrame& frame, AddPoint add, Finish finish) {
  using Result = typename std::invoke_result_t<Finish, const VoxelKey&, const Sums&>::value_type;
  const auto use = [&](std::vector<Result>& results, const VoxelKey& key, const Sums& sums) {
    if (auto result = finish(key, sums)) results.push_back(std::move(*result));
  };
  std::vector<Result> all;
  for (auto& results : fold_voxels<std::vector<Result>, Sums>(cloud, frame, add, use)) {
    std::ranges::move(results, std::back_inserter(all));
  }
  return all;
}

}  // namespace cmap
