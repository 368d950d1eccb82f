#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "cmap/geometry/voxel_map.hpp"
#include "voxels.hpp"

namespace cmap {

/// A grid of voxels anchored at the world's origin, and the same grid shifted by parts of a voxel: every voxel has
/// m x m x m parts, and voxel q of the grid shifted by k parts holds those of index (part + k) / m, floored, on each
/// axis. A phase is one of the m^3 shifts, numbered x slowest; phase 0 is none.
class PhasedFrame {
 public:
  PhasedFrame(const Box3d& box, double voxel_m, int parts_per_axis)
      : voxels_(box, voxel_m), first_(voxels_.index(VoxelKey{})), voxel_m_(voxel_m), m_(parts_per_axis) {}

  const VoxelFrame& voxels() const { return voxels_; }
  double voxel_m() const { return voxel_m_; }
  int parts_per_axis() const { return m_; }
  int n_phases() const { return m_ * m_ * m_; }
  /// By how many parts a phase is shifted.
  LocalKey shift(int phase) const { return {phase / (m_ * m_), phase / m_ % m_, phase % m_}; }

  /// A voxel and the part of it in which a place lies: floor(m x / voxel) - m floor(x / voxel) on each axis; a place
  /// that rounding would put into another voxel stays in its own.
  struct Place {
    VoxelKey voxel;
    LocalKey part;
  };
  Place place(const Eigen::Vector3d& world) const {
    const auto [x, px] = on_axis(world.x(), first_[0]);
    const auto [y, py] = on_axis(world.y(), first_[1]);
    const auto [z, pz] = on_axis(world.z(), first_[2]);
    return {{x, y, z}, {px, py, pz}};
  }

 private:
  struct AxisPlace {
    std::int32_t key, part;
  };

  AxisPlace on_axis(double world, std::int64_t first) const {
    const double at = world / voxel_m_;
    const auto truncated = static_cast<std::int64_t>(at);
    const std::int64_t index = truncated - (at < static_cast<double>(truncated) ? 1 : 0);
    const auto key = static_cast<std::int32_t>(index - first);
    if (m_ == 1) return {key, 0};
    if (m_ == 2) return {key, at >= static_cast<double>(index) + 0.5 ? 1 : 0};  // 2 x / voxel is exactly twice as much
    const double in_parts = m_ * world / voxel_m_, begin = m_ * static_cast<double>(index);
    std::int32_t part = 0;
    for (std::int32_t p = 1; p < m_; ++p) part += in_parts >= begin + static_cast<double>(p) ? 1 : 0;
    return {key, part};
  }

  VoxelFrame voxels_;
  std::array<std::int64_t, 3> first_;
  double voxel_m_;
  int m_;
};

}  // namespace cmap
