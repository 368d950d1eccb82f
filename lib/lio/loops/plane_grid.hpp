#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/geometry/voxel_map.hpp"

namespace cmap {

/// A patch of surface: where its points spread across a direction far less than along.
struct PlanePatch {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double thickness_m = 0.0;  ///< RMS distance of its points from it
  std::size_t n = 0;
};

/// The plane of some points, where they have one: at least 6, spread along it over an eighth of `size_m` or more, and
/// across it by less than a third of that along it.
std::optional<PlanePatch> plane_of(std::span<const Eigen::Vector3d> points, double size_m);

/// A cloud's surface, a patch a voxel.
class PlaneGrid {
 public:
  PlaneGrid(const PointCloud& cloud, double size_m);

  const std::vector<PlanePatch>& patches() const { return patches_; }
  double size_m() const { return size_m_; }
  /// The patch nearest to a point along its own normal, of the voxel that holds the point and the voxels beside it.
  const PlanePatch* nearest(const Eigen::Vector3d& p) const;
  /// Whether there are points within a column of the size of four voxels about (x, y): the place was seen.
  bool was_seen(const Eigen::Vector3d& p) const { return seen_.find(column(p)) != nullptr; }

 private:
  VoxelKey key(const Eigen::Vector3d& p) const;
  VoxelKey column(const Eigen::Vector3d& p) const;

  double size_m_;
  VoxelMap<std::uint32_t> by_voxel_;  ///< place in patches_
  VoxelMap<std::uint8_t> seen_;
  std::vector<PlanePatch> patches_;
};

}  // namespace cmap
