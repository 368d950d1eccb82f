#include "voxels.hpp"

#include <tuple>

namespace cmap {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16;

VoxelKey cell_of(const VoxelKey& key) { return {key.x >> kCellBits, key.y >> kCellBits, key.z >> kCellBits}; }

std::vector<CellRun> runs_of_chunk(const PointBlocks& points, const VoxelFrame& frame, std::size_t begin,
                                   std::size_t end) {
  std::vector<CellRun> runs;
  for (std::size_t slot = begin; slot < end; ++slot) {
    const VoxelKey cell = cell_of(frame.key(points.world(slot)));
    if (runs.empty() || runs.back().cell != cell) runs.push_back({cell, slot, slot});
    runs.back().end = slot + 1;
  }
  return runs;
}

}  // namespace

std::vector<CellRun> cell_runs(const PointBlocks& points, const VoxelFrame& frame) {
  std::vector<std::vector<CellRun>> by_chunk((points.size + kChunk - 1) / kChunk);
  parallel_chunks(points.size, kChunk, [&](std::size_t begin, std::size_t end) {
    by_chunk[begin / kChunk] = runs_of_chunk(points, frame, begin, end);
  });
  std::vector<CellRun> runs;
  for (const auto& chunk : by_chunk) runs.insert(runs.end(), chunk.begin(), chunk.end());
  std::ranges::sort(runs, {}, [](const CellRun& r) { return std::tuple(r.cell.x, r.cell.y, r.cell.z, r.begin); });
  return runs;
}

std::vector<std::span<const CellRun>> cell_tasks(std::span<const CellRun> runs) {
  std::vector<std::span<const CellRun>> tasks;
  std::size_t begin = 0, n_points = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    n_points += runs[i].end - runs[i].begin;
    const bool ends_cell = i + 1 == runs.size() || runs[i + 1].cell != runs[i].cell;
    if (!ends_cell || (n_points < kChunk && i + 1 < runs.size())) continue;
    tasks.push_back(runs.subspan(begin, i + 1 - begin));
    begin = i + 1;
    n_points = 0;
  }
  return tasks;
}

}  // namespace cmap
