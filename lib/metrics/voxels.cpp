#include "voxels.hpp"

#include <utility>

namespace cmap {
namespace {

VoxelKey cell_of(const VoxelKey& key, int bits) { return {key.x >> bits, key.y >> bits, key.z >> bits}; }

/// By cell and slot, in two words: keys are not negative, and there are at most 2^31 slots.
std::pair<std::uint64_t, std::uint64_t> order_of(const CellRun& run) {
  const auto word = [](std::int64_t high, std::uint64_t low) { return static_cast<std::uint64_t>(high) << 32 | low; };
  return {word(run.cell.x, static_cast<std::uint64_t>(run.cell.y)), word(run.cell.z, run.begin)};
}

class RunsOfChunk {
 public:
  RunsOfChunk(const Bvh& cloud, const VoxelFrame& frame, int bits) : cloud_(cloud), frame_(frame), bits_(bits) {}

  std::vector<CellRun> operator()(std::size_t begin, std::size_t end) {
    const PointBlocks& points = cloud_.points;
    for (std::size_t slot = begin; slot < end;) {
      const std::size_t block_end = std::min(end, slot + kBlockSize);
      const auto [low, high] = corners(slot / kBlockSize);
      if (low == high) {
        append(low, slot, block_end);
      } else {
        for (std::size_t i = slot; i < block_end; ++i) append(cell_at(points.world(i)), i, i + 1);
      }
      slot = block_end;
    }
    return std::move(runs_);
  }

 private:
  VoxelKey cell_at(const Eigen::Vector3d& world) const { return cell_of(frame_.key(world), bits_); }

  /// The cells in which the corners of a block's box lie; keys grow with coordinates.
  std::pair<VoxelKey, VoxelKey> corners(std::size_t block) const {
    const BoxNode& node = cloud_.boxes.front()[block / kBlockSize];
    const std::size_t c = block % kBlockSize;
    const Eigen::Vector3d low(node.min_x[c], node.min_y[c], node.min_z[c]);
    const Eigen::Vector3d high(node.max_x[c], node.max_y[c], node.max_z[c]);
    return {cell_at(cloud_.points.origin + low), cell_at(cloud_.points.origin + high)};
  }

  void append(const VoxelKey& cell, std::size_t begin, std::size_t end) {
    if (runs_.empty() || runs_.back().cell != cell) runs_.push_back({cell, begin, begin});
    runs_.back().end = end;
  }

  const Bvh& cloud_;
  const VoxelFrame& frame_;
  int bits_;
  std::vector<CellRun> runs_;
};

}  // namespace

std::vector<CellRun> cell_runs(const Bvh& cloud, const VoxelFrame& frame, int cell_bits) {
  const std::size_t n = cloud.points.size;
  std::vector<std::vector<CellRun>> by_chunk((n + kTaskPoints - 1) / kTaskPoints);
  parallel_chunks(n, kTaskPoints, [&](std::size_t begin, std::size_t end) {
    by_chunk[begin / kTaskPoints] = RunsOfChunk(cloud, frame, cell_bits)(begin, end);
  });
  std::vector<CellRun> runs;
  for (const auto& chunk : by_chunk) runs.insert(runs.end(), chunk.begin(), chunk.end());
  std::ranges::sort(runs, {}, [](const CellRun& run) { return order_of(run); });
  return runs;
}

std::vector<std::span<const CellRun>> cell_tasks(std::span<const CellRun> runs) {
  return point_tasks(
      runs, [](const CellRun& run) { return run.end - run.begin; },
      [&](std::size_t i) { return runs[i + 1].cell != runs[i].cell; });
}

}  // namespace cmap
