#pragma once

#include <algorithm>
#include <array>
#include <bit>
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

/// Sums of the places of one cell; every place has its entry in a table that fits the second-level cache.
template <class Sums>
class LocalGrid {
 public:
  struct Entry {
    std::int32_t place;
    Sums sums;
  };

  explicit LocalGrid(std::int32_t n_places)
      : entry_at_(static_cast<std::size_t>(n_places), kFree), is_taken_(entry_at_.size() / 64 + 1) {}

  Sums& operator[](std::int32_t place) {
    std::uint32_t& entry = entry_at_[static_cast<std::size_t>(place)];
    if (entry == kFree) [[unlikely]]
      entry = add_entry(place);
    return entries_[entry].sums;
  }
  const Sums* find(std::int32_t place) const {
    const std::uint32_t entry = entry_at_[static_cast<std::size_t>(place)];
    return entry == kFree ? nullptr : &entries_[entry].sums;
  }
  /// In order of first use.
  std::span<const Entry> entries() const { return entries_; }
  /// Hands entries to use(place, sums) in order of places.
  template <class Use>
  void in_order(Use use) const {
    for (std::size_t word = 0; word < is_taken_.size(); ++word) {
      for (std::uint64_t bits = is_taken_[word]; bits != 0; bits &= bits - 1) {
        const std::size_t place = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
        use(static_cast<std::int32_t>(place), entries_[entry_at_[place]].sums);
      }
    }
  }
  /// Makes room for the next cell.
  void clear() {
    for (const Entry& entry : entries_) {
      entry_at_[static_cast<std::size_t>(entry.place)] = kFree;
      is_taken_[static_cast<std::size_t>(entry.place) / 64] = 0;
    }
    entries_.clear();
  }

 private:
  static constexpr std::uint32_t kFree = ~0u;

  [[gnu::noinline]] std::uint32_t add_entry(std::int32_t place) {
    is_taken_[static_cast<std::size_t>(place) / 64] |= std::uint64_t{1} << (place % 64);
    entries_.push_back({place, {}});
    return static_cast<std::uint32_t>(entries_.size() - 1);
  }

  std::vector<std::uint32_t> entry_at_;
  std::vector<std::uint64_t> is_taken_;  ///< a bit for each place
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
    LocalGrid<Sums> voxels(kEdge * kEdge * kEdge);
    VoxelKey cell = tasks[i].front().cell;
    const auto use_cell = [&] {
      for (const auto& [place, sums] : voxels.entries()) {
        const VoxelKey key{cell.x * kEdge + place / (kEdge * kEdge), cell.y * kEdge + place / kEdge % kEdge,
                           cell.z * kEdge + place % kEdge};
        use(results[i], key, sums);
      }
      voxels.clear();
    };
    for (const CellRun& run : tasks[i]) {
      if (run.cell != cell) use_cell();
      cell = run.cell;
      for_places(cloud.points, grid, run.begin, run.end,
                 [&](std::size_t slot, std::int32_t place) { add(voxels[place], slot); });
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
