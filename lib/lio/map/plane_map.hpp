#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>
#include <span>

#include "cmap/geometry/voxel_map.hpp"
#include "map/plane.hpp"

namespace cmap {

/// A point of a scan in the world, and how uncertain it is across a surface.
struct MapPoint {
  Eigen::Vector3d position;  ///< m
  double variance_m2 = 0.0;
};

struct PlaneMapOptions {
  double voxel_m = 1.0;     ///< edge of the largest cells
  int levels = 3;           ///< cells that are no plane are halved, that many sizes in all
  double most_points = 80;  ///< a cell's plane is settled once it has as many
  /// Cells that were last seen so much path ago have drifted against what is seen now: they are not matched, and begin
  /// anew.
  double forget_after_m = 300.0;
  PlaneRule plane;
};

/// Planes in a hash map of voxels, each an octree of few levels (Yuan et al. 2022). Only sums of points are kept. The
/// result depends on the order of the points of one scan by rounding alone.
class PlaneMap {
 public:
  explicit PlaneMap(const PlaneMapOptions& options) : options_(options) {}

  /// Adds the points of one scan; `path_m` is how far the sensor has come.
  void add(std::span<const MapPoint> points, double path_m);

  /// The plane of the cell that a point lies in; null where there is none.
  const Plane* find(const Eigen::Vector3d& point) const;
  /// The same of the neighboring cell that is nearest to the point.
  const Plane* find_beside(const Eigen::Vector3d& point) const;

  std::size_t n_cells() const { return roots_.entries().size(); }

 private:
  struct Cell {
    PointSums sums;  ///< about the cell's corner
    Plane plane;
    bool is_plane = false;
    std::array<Cell, 8>* children = nullptr;
  };
  struct Root {
    Cell cell;
    double seen_at_m = 0.0;         ///< path
    std::uint32_t first_point = 0;  ///< 1 + index of the first of this scan's points here; 0: none
  };

  VoxelKey key_of(const Eigen::Vector3d& point) const;
  const Plane* find(const VoxelKey& key, const Eigen::Vector3d& point) const;
  void add_to(Cell& cell, const Eigen::Vector3d& corner, double size_m, int level, std::span<const MapPoint> points);

  PlaneMapOptions options_;
  VoxelMap<Root> roots_;
  std::deque<std::array<Cell, 8>> children_;  ///< of all cells
  double path_m_ = 0.0;
};

}  // namespace cmap
