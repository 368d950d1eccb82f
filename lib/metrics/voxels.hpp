#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "cmap/core/parallel.hpp"
#include "cmap/spatial/bvh.hpp"
#include "cmap/spatial/voxel_map.hpp"

namespace cmap {

/// Consecutive slots of a sorted cloud within one cell of 32 x 32 x 32 voxels.
struct CellRun {
  VoxelKey cell;
  std::size_t begin;
  std::size_t end;
};

/// The cloud as runs, ordered by cell and slot. Neighbors on the curve are neighbors in space, so runs are few.
std::vector<CellRun> cell_runs(const PointBlocks& points, const VoxelFrame& frame);

/// Sums the points of every voxel with add(sums, slot, world, key) and turns them into a result, or none, with
/// finish(key, sums); results are ordered by cell. Cells of voxels are independent: each sums into a small map of its
/// own, in parallel and in the order of slots, so that the result is the same for any number of threads.
template <class Sums, class AddPoint, class Finish>
auto collect_voxels(const PointBlocks& points, const VoxelFrame& frame, AddPoint add, Finish finish) {
  using Result = typename std::invoke_result_t<Finish, const VoxelKey&, const Sums&>::value_type;
  const std::vector<CellRun> runs = cell_runs(points, frame);
  std::vector<std::span<const CellRun>> cells;
  for (auto begin = runs.begin(); begin != runs.end();) {
    const auto end = std::find_if(begin, runs.end(), [&](const CellRun& run) { return run.cell != begin->cell; });
    cells.emplace_back(begin, end);
    begin = end;
  }

  std::vector<std::vector<Result>> by_cell(cells.size());
  parallel_chunks(cells.size(), 1, [&](std::size_t i, std::size_t) {
    VoxelMap<Sums> voxels;
    for (const CellRun& run : cells[i]) {
      for (std::size_t slot = run.begin; slot < run.end; ++slot) {
        const Eigen::Vector3d world = points.world(slot);
        const VoxelKey key = frame.key(world);
        add(voxels[key], slot, world, key);
      }
    }
    for (const auto& [key, sums] : voxels.entries()) {
      if (auto result = finish(key, sums)) by_cell[i].push_back(std::move(*result));
    }
  });

  std::vector<Result> all;
  for (std::vector<Result>& cell : by_cell) std::ranges::move(cell, std::back_inserter(all));
  return all;
}

}  // namespace cmap
