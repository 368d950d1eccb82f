#pragma once

#include <vector>

#include "cmap/spatial/point_blocks.hpp"

namespace cmap {

/// Boxes of sixteen children, in the coordinates of what they bound.
struct alignas(64) BoxNode {
  float min_x[kBlockSize], min_y[kBlockSize], min_z[kBlockSize];
  float max_x[kBlockSize], max_y[kBlockSize], max_z[kBlockSize];
};

/// Lowest original index below each of sixteen children.
struct LowestIndex {
  std::uint32_t child[kBlockSize];
};

/// Boxes over blocks, then over nodes, sixteen at a time: level 0 bounds blocks, the last level is one node.
/// Child c of node i of level l is node 16 i + c of level l - 1 (block 16 i + c for l = 0); absent children are empty
/// boxes (min +inf, max -inf).
using BoxLevels = std::vector<Array<BoxNode>>;

/// The implicit 16-ary bounding-volume hierarchy over a sorted cloud. Immutable; all searches are thread-safe.
struct Bvh {
  explicit Bvh(PointBlocks sorted_points);

  /// Bounds of the points, world frame.
  Box3d bounds() const;

  PointBlocks points;
  BoxLevels boxes;
  /// By level like `boxes`: lets searches prune among equally near points.
  std::vector<Array<LowestIndex>> lowest_index;
};

/// The same boxes over the colors of a sorted cloud (axes r, g, b).
BoxLevels color_boxes(const Array<ColorBlock>& colors);

}  // namespace cmap
