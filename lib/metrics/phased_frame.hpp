#pragma once

#include "cmap/geometry/voxel_map.hpp"

namespace cmap {

/// A grid of voxels anchored at the world's origin, and the same grid shifted by parts of a voxel: every voxel has
/// m x m x m parts, floor(m x / voxel) - m floor(x / voxel) on each axis (a place that rounding would put into another
/// voxel stays in its own), and voxel q of the grid shifted by k parts holds those of index (part + k) / m, floored, on
/// each axis. A phase is one of the m^3 shifts, numbered x slowest; phase 0 is none.
class PhasedFrame {
 public:
  PhasedFrame(const Box3d& box, double voxel_m, int parts_per_axis) : voxels_(box, voxel_m), m_(parts_per_axis) {}

  const VoxelFrame& voxels() const { return voxels_; }
  int parts_per_axis() const { return m_; }
  int n_phases() const { return m_ * m_ * m_; }

 private:
  VoxelFrame voxels_;
  int m_;
};

}  // namespace cmap
