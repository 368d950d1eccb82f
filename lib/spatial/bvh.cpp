#include "cmap/spatial/bvh.hpp"

#include <algorithm>
#include <limits>

#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

constexpr std::size_t kNodeChunk = 1024;

std::size_t parents_of(std::size_t n_children) { return (n_children + kBlockSize - 1) / kBlockSize; }

struct Extent {
  float min, max;
};

Extent extent_of(const float (&lows)[kBlockSize], const float (&highs)[kBlockSize]) {
  using Values = Eigen::Map<const Eigen::Array<float, kBlockSize, 1>>;
  return {Values(lows).minCoeff(), Values(highs).maxCoeff()};
}

void set_child(BoxNode& node, std::size_t c, Extent x, Extent y, Extent z) {
  node.min_x[c] = x.min;
  node.max_x[c] = x.max;
  node.min_y[c] = y.min;
  node.max_y[c] = y.max;
  node.min_z[c] = z.min;
  node.max_z[c] = z.max;
}

/// One level of nodes; bound_child(node, c, child) sets the box of an existing child.
template <class BoundChild>
Array<BoxNode> box_level(std::size_t n_children, BoundChild&& bound_child) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Array<BoxNode> nodes(parents_of(n_children));
  parallel_chunks(nodes.size(), kNodeChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t c = 0; c < kBlockSize; ++c) {
        const std::size_t child = i * kBlockSize + c;
        const Extent absent{kInfinity, -kInfinity};
        set_child(nodes[i], c, absent, absent, absent);
        if (child < n_children) bound_child(nodes[i], c, child);
      }
    }
  });
  return nodes;
}

/// All levels above blocks whose boxes bound_block(node, c, block) sets.
template <class BoundBlock>
BoxLevels box_levels(std::size_t n_blocks, BoundBlock&& bound_block) {
  BoxLevels levels;
  levels.push_back(box_level(n_blocks, bound_block));
  while (levels.back().size() > 1) {
    const Array<BoxNode>& below = levels.back();
    levels.push_back(box_level(below.size(), [&below](BoxNode& node, std::size_t c, std::size_t child) {
      const BoxNode& b = below[child];
      set_child(node, c, extent_of(b.min_x, b.max_x), extent_of(b.min_y, b.max_y), extent_of(b.min_z, b.max_z));
    }));
  }
  return levels;
}

std::vector<Array<LowestIndex>> lowest_indices(const PointBlocks& points) {
  std::vector<Array<LowestIndex>> levels;
  const std::uint32_t* below = points.original_index.data();
  std::size_t n_below = points.blocks.size();
  do {
    Array<LowestIndex> level(parents_of(n_below));
    for (std::size_t child = 0; child < level.size() * kBlockSize; ++child) {
      level[child / kBlockSize].child[child % kBlockSize] =
          child < n_below ? *std::min_element(below + child * kBlockSize, below + (child + 1) * kBlockSize)
                          : std::numeric_limits<std::uint32_t>::max();
    }
    n_below = level.size();
    levels.push_back(std::move(level));
    below = levels.back().data()->child;
  } while (n_below > 1);
  return levels;
}

}  // namespace

Bvh::Bvh(PointBlocks sorted_points)
    : points(std::move(sorted_points)),
      boxes(box_levels(points.blocks.size(),
                       [this](BoxNode& node, std::size_t c, std::size_t block) {
                         const PointBlock& p = points.blocks[block];
                         set_child(node, c, extent_of(p.x, p.x), extent_of(p.y, p.y), extent_of(p.z, p.z));
                       })),
      lowest_index(lowest_indices(points)) {}

Box3d Bvh::bounds() const {
  const BoxNode& root = boxes.back().front();
  const Extent x = extent_of(root.min_x, root.max_x);
  const Extent y = extent_of(root.min_y, root.max_y);
  const Extent z = extent_of(root.min_z, root.max_z);
  return {points.origin + Eigen::Vector3f(x.min, y.min, z.min).cast<double>(),
          points.origin + Eigen::Vector3f(x.max, y.max, z.max).cast<double>()};
}

BoxLevels color_boxes(const Array<ColorBlock>& colors) {
  return box_levels(colors.size(), [&](BoxNode& node, std::size_t c, std::size_t block) {
    const ColorBlock& color = colors[block];
    set_child(node, c, extent_of(color.r, color.r), extent_of(color.g, color.g), extent_of(color.b, color.b));
  });
}

}  // namespace cmap
