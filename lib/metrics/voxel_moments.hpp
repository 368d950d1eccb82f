#pragma once

#include <array>
#include <cstdint>

#include "cmap/geometry/voxel_map.hpp"
#include "cmap/metrics/wasserstein.hpp"
#include "whole_sums.hpp"

namespace cmap {

/// An offset from the corner of a voxel in whole steps.
using OffsetSteps = std::array<std::uint32_t, 3>;

/// A place in a frame of voxels, in whole steps from the corner of its voxel of key 0.
using Corner = std::array<std::int64_t, 3>;

/// Steps for the offsets of points from the corners of their voxels: 2^-30 m; where voxels have 4 m or more, the power
/// of two of which at most 2^32 reach across one. The same in every frame of voxels of that size.
class VoxelSteps {
 public:
  explicit VoxelSteps(double voxel_m);

  double step_m() const { return step_m_; }
  /// Voxels are as many whole steps apart, whatever is left over.
  std::int64_t steps_per_voxel() const { return steps_per_voxel_; }
  Corner corner(const VoxelKey& voxel) const {
    return {voxel.x * steps_per_voxel_, voxel.y * steps_per_voxel_, voxel.z * steps_per_voxel_};
  }

 private:
  double step_m_;
  std::int64_t steps_per_voxel_;
};

/// Number, sums and sums of products of a voxel's points about some corner, in steps: whole numbers, so that neither
/// the order nor the grouping of the points changes a bit. Words wrap: about a far corner the sums are right but for
/// multiples of 2^64 and 2^128, which cancel where what is asked for is about a near one. For up to 2^31 points. Not
/// thread-safe.
class VoxelMoments {
 public:
  void add(const OffsetSteps& at) {
    const std::uint64_t x = at[0], y = at[1], z = at[2];
    ++n_;
    sum_[0] += x;
    sum_[1] += y;
    sum_[2] += z;
    products_[0].add(x * x);
    products_[1].add(x * y);
    products_[2].add(x * z);
    products_[3].add(y * y);
    products_[4].add(y * z);
    products_[5].add(z * z);
  }
  VoxelMoments& operator+=(const VoxelMoments& other);
  /// Takes points off that are among them.
  VoxelMoments& operator-=(const VoxelMoments& other);
  /// Moves the points, whose sums have not wrapped yet, away from the corner.
  void move(const Corner& by);

  std::uint64_t n() const { return n_; }
  /// Mean from this corner, less than 2^33 steps before any of the points, and scatter, meters; of at least one point.
  Gaussian gaussian(double step_m, const Corner& from = {}) const;

  friend bool operator==(const VoxelMoments&, const VoxelMoments&) = default;

 private:
  std::uint64_t n_ = 0;
  std::array<std::uint64_t, 3> sum_{};
  std::array<WideSum, 6> products_{};  ///< xx, xy, xz, yy, yz, zz
};

}  // namespace cmap
