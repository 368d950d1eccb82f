#pragma once

#include <Eigen/Core>
#include <span>

#include "cmap/geometry/voxel_map.hpp"
#include "cmap/spatial/bvh.hpp"

namespace cmap {

struct VisibilityOptions {
  double voxel_m = 0.5;    ///< what the map's surfaces are made of
  double range_m = 100.0;  ///< farther surfaces are not seen
};

/// The surfaces of a map that can be seen from a sensor's path: voxels that hold points, in sight of any position
/// where no other voxel that holds points lies between. A line of sight begins a voxel's diagonal above its surface
/// (along the normal of the voxel's points, toward the sensor), so that ground seen at a flat angle does not hide
/// itself. Positions nearer than a voxel to the one before are left out. Thread-safe once made; the same for any number
/// of threads. Throws UsageError where voxels are too small for the map, std::invalid_argument without points or
/// positions.
class VisibleSurfaces {
 public:
  VisibleSurfaces(const Bvh& map, std::span<const Eigen::Vector3d> positions, const VisibilityOptions& options);

  /// Whether the voxel around a point of the map was seen; false where the map has none.
  bool contains(const Eigen::Vector3d& world) const;

  std::size_t n_positions() const { return n_positions_; }

 private:
  VoxelFrame frame_;
  Box3d box_;
  VoxelMap<bool> seen_;
  std::size_t n_positions_ = 0;
};

}  // namespace cmap
