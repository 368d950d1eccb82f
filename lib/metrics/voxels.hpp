#pragma once

#include "cmap/spatial/point_blocks.hpp"
#include "cmap/spatial/voxel_map.hpp"

namespace cmap {

/// World bounds of sorted points.
inline Box3d bounds(const PointBlocks& points) {
  Eigen::Vector3f lowest = points.offset(0);
  Eigen::Vector3f highest = lowest;
  for (std::size_t slot = 1; slot < points.size; ++slot) {
    lowest = lowest.cwiseMin(points.offset(slot));
    highest = highest.cwiseMax(points.offset(slot));
  }
  return {points.origin + lowest.cast<double>(), points.origin + highest.cast<double>()};
}

}  // namespace cmap
