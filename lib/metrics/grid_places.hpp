#pragma once

#include <algorithm>

#include "cmap/geometry/voxel_map.hpp"
#include "cmap/spatial/point_blocks.hpp"
#include "simd/kernels.hpp"

namespace cmap {

/// For the points of one cloud in a frame of voxels that has parts and cells. Before the parts of a cell there is room
/// for `margin` more on each axis.
inline PartGrid part_grid(const PointBlocks& points, const VoxelFrame& frame, int parts_per_axis, int voxels_per_cell,
                          int margin = 0) {
  const int edge = parts_per_axis * voxels_per_cell + margin;
  const std::array<std::int64_t, 3> first = frame.index(VoxelKey{});
  PartGrid grid{.origin = {},
                .voxel_m = frame.size_m(),
                .first = {},
                .parts_per_axis = parts_per_axis,
                .voxels_per_cell = voxels_per_cell,
                .edge = edge,
                .first_place = margin * (edge * edge + edge + 1)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.origin[axis] = points.origin[static_cast<Eigen::Index>(axis)];
    grid.first[axis] = static_cast<double>(first[axis]);
  }
  return grid;
}

/// Hands the slots of [begin, end), block by block, to use(first, end, places): of the points of the whole block.
template <class Use>
void for_blocks(const PointBlocks& points, const PartGrid& grid, std::size_t begin, std::size_t end, Use use) {
  GridPlaces places;
  for (std::size_t slot = begin; slot < end;) {
    const std::size_t block = slot / kBlockSize, block_end = std::min(end, (block + 1) * kBlockSize);
    metric_kernels().grid_places(grid, points.blocks[block], places);
    use(slot, block_end, places);
    slot = block_end;
  }
}

/// Hands every slot of [begin, end) to use(slot, place), the place being its part's place in its cell.
template <class Use>
void for_places(const PointBlocks& points, const PartGrid& grid, std::size_t begin, std::size_t end, Use use) {
  for_blocks(points, grid, begin, end, [&](std::size_t slot, std::size_t block_end, const GridPlaces& places) {
    for (; slot < block_end; ++slot) use(slot, places.in_cell[slot % kBlockSize]);
  });
}

}  // namespace cmap
