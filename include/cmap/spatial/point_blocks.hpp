#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "cmap/core/array.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

inline constexpr std::size_t kBlockSize = 16;

/// Sixteen neighboring points, one coordinate after the other: the unit of every search.
struct alignas(64) PointBlock {
  float x[kBlockSize], y[kBlockSize], z[kBlockSize];
};

/// Sixteen colors, RGB in units of 1/255, in the same slots as the points.
struct alignas(64) ColorBlock {
  float r[kBlockSize], g[kBlockSize], b[kBlockSize];
};

/// The points of one cloud along a Hilbert curve. The point in slot s is lane s % 16 of blocks[s / 16] and was point
/// original_index[s] of the cloud; points with equal keys keep their order. The last block repeats the last point.
struct PointBlocks {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< offsets in the blocks are from here, m, world frame
  std::size_t size = 0;
  Array<PointBlock> blocks;
  Array<std::uint32_t> original_index;  ///< blocks.size() * 16 entries

  Eigen::Vector3f offset(std::size_t slot) const {
    const PointBlock& block = blocks[slot / kBlockSize];
    const std::size_t lane = slot % kBlockSize;
    return {block.x[lane], block.y[lane], block.z[lane]};
  }
  Eigen::Vector3d world(std::size_t slot) const { return origin + offset(slot).cast<double>(); }
};

/// Sorts a cloud along a Hilbert curve through its bounds, 2048 cells an axis; cells with very many points are refined.
/// Deterministic for any number of threads. Throws UnsupportedError above 2^31 points, std::invalid_argument when
/// empty.
PointBlocks sort_points(const PointCloud& cloud);

/// These slots of a cloud as queries, in this order: no original_index.
PointBlocks chosen_points(const PointBlocks& points, const Array<std::uint32_t>& slots);

/// The cloud's colors in the slots of `points`. The cloud must have colors and be the one that was sorted.
Array<ColorBlock> sort_colors(const PointCloud& cloud, const PointBlocks& points);

inline Eigen::Vector3f color_at(const Array<ColorBlock>& colors, std::size_t slot) {
  const ColorBlock& block = colors[slot / kBlockSize];
  const std::size_t lane = slot % kBlockSize;
  return {block.r[lane], block.g[lane], block.b[lane]};
}

/// Values per slot put back into the cloud's own order.
template <class T>
Array<T> in_original_order(const PointBlocks& points, const Array<T>& by_slot) {
  Array<T> values(points.size);
  for (std::size_t slot = 0; slot < points.size; ++slot) values[points.original_index[slot]] = by_slot[slot];
  return values;
}

}  // namespace cmap
