#include "voxels.hpp"

#include <bit>
#include <utility>

#include "cmap/spatial/radix_sort.hpp"

namespace cmap {
namespace {

constexpr int kIndexBits = 32;

/// The cell of what is within a box, as far as the box says.
struct BoxCell {
  std::int32_t at[3] = {};
  bool known[3] = {};

  bool is_one() const { return known[0] && known[1] && known[2]; }
  VoxelKey key() const { return {at[0], at[1], at[2]}; }
};

/// The runs below one node: from the top down, each axis until a box lies within one cell on it.
class RunsOfNode {
 public:
  RunsOfNode(const Bvh& cloud, const VoxelFrame& frame, int bits) : cloud_(cloud), frame_(frame), bits_(bits) {}

  std::vector<CellRun> operator()(std::size_t level, std::size_t node) {
    visit(level, node, {});
    return std::move(runs_);
  }

 private:
  void visit(std::size_t level, std::size_t node, const BoxCell& around) {
    const std::size_t n_slots = kBlockSize << (4 * level);
    for (std::size_t c = 0; c < kBlockSize; ++c) {
      const std::size_t child = node * kBlockSize + c;
      if (child * n_slots >= cloud_.points.size) return;
      const BoxCell cell = narrowed(around, cloud_.boxes[level][node], c);
      if (cell.is_one()) {
        append(cell.key(), child * n_slots, std::min((child + 1) * n_slots, cloud_.points.size));
      } else if (level > 0) {
        visit(level - 1, child, cell);
      } else {
        visit_points(child, cell);
      }
    }
  }

  std::int32_t cell_at(std::size_t axis, float offset) const {
    const double world = cloud_.points.origin[static_cast<Eigen::Index>(axis)] + static_cast<double>(offset);
    return frame_.axis_key(static_cast<int>(axis), world) >> bits_;
  }

  /// On the axes that are not known yet; keys grow with coordinates.
  BoxCell narrowed(BoxCell cell, const BoxNode& node, std::size_t c) const {
    const float low[]{node.min_x[c], node.min_y[c], node.min_z[c]};
    const float high[]{node.max_x[c], node.max_y[c], node.max_z[c]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cell.known[axis]) continue;
      cell.at[axis] = cell_at(axis, low[axis]);
      cell.known[axis] = cell_at(axis, high[axis]) == cell.at[axis];
    }
    return cell;
  }

  void visit_points(std::size_t block, BoxCell cell) {
    const PointBlock& points = cloud_.points.blocks[block];
    const float* const offsets[]{points.x, points.y, points.z};
    const std::size_t first = block * kBlockSize, n = std::min(kBlockSize, cloud_.points.size - first);
    for (std::size_t lane = 0; lane < n; ++lane) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!cell.known[axis]) cell.at[axis] = cell_at(axis, offsets[axis][lane]);
      }
      append(cell.key(), first + lane, first + lane + 1);
    }
  }

  void append(const VoxelKey& cell, std::size_t begin, std::size_t end) {
    if (runs_.empty() || runs_.back().cell != cell) runs_.push_back({cell, static_cast<std::uint32_t>(begin), 0});
    runs_.back().end = static_cast<std::uint32_t>(end);
  }

  const Bvh& cloud_;
  const VoxelFrame& frame_;
  int bits_;
  std::vector<CellRun> runs_;
};

/// By cell; those of one cell stay in their order.
std::vector<CellRun> sorted_by_cell(const std::vector<CellRun>& runs) {
  Array<std::uint64_t> order(runs.size()), scratch;
  for (std::size_t i = 0; i < runs.size(); ++i) order[i] = i;
  for (const auto axis : {&VoxelKey::z, &VoxelKey::y, &VoxelKey::x}) {
    std::uint32_t largest = 0;
    for (std::uint64_t& entry : order) {
      const auto index = static_cast<std::uint32_t>(entry);
      const auto at = static_cast<std::uint32_t>(runs[index].cell.*axis);  // not negative
      entry = static_cast<std::uint64_t>(at) << kIndexBits | index;
      largest = std::max(largest, at);
    }
    radix_sort(order, scratch, kIndexBits, kIndexBits + static_cast<int>(std::bit_width(largest)));
  }
  std::vector<CellRun> sorted;
  sorted.reserve(runs.size());
  for (const std::uint64_t entry : order) sorted.push_back(runs[static_cast<std::uint32_t>(entry)]);
  return sorted;
}

}  // namespace

std::vector<CellRun> cell_runs(const Bvh& cloud, const VoxelFrame& frame, int cell_bits) {
  constexpr std::size_t kTaskLevel = 2;  // a node of it is over kTaskPoints
  const std::size_t level = std::min(kTaskLevel, cloud.boxes.size() - 1);
  std::vector<std::vector<CellRun>> by_node(cloud.boxes[level].size());
  parallel_chunks(by_node.size(), 1, [&](std::size_t node, std::size_t) {
    by_node[node] = RunsOfNode(cloud, frame, cell_bits)(level, node);
  });
  std::size_t n = 0;
  for (const auto& runs : by_node) n += runs.size();
  std::vector<CellRun> all;
  all.reserve(n);
  for (auto& runs : by_node) {
    all.insert(all.end(), runs.begin(), runs.end());
    runs = {};
  }
  return sorted_by_cell(all);
}

std::vector<std::span<const CellRun>> cell_tasks(std::span<const CellRun> runs) {
  return point_tasks(
      runs, [](const CellRun& run) { return std::size_t{run.end - run.begin}; },
      [&](std::size_t i) { return runs[i + 1].cell != runs[i].cell; });
}

}  // namespace cmap
