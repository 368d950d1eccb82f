#pragma once

#include <cstddef>

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/capture.hpp"

namespace cmap {

struct ScanMapOptions {
  double voxel_m = 0.1;      ///< mean of the points in each
  double min_range_m = 0.5;  ///< nearer returns are the carrier's own
  double max_gap_s = 0.15;   ///< poses farther apart are not interpolated between
};

struct ScanMap {
  PointCloud cloud;          ///< no color; in the order in which voxels first occur
  std::size_t n_scans = 0;   ///< that were read
  std::size_t n_points = 0;  ///< of these scans
  std::size_t n_placed = 0;  ///< of these, those with a pose and outside min_range_m
};

/// All scans of a capture along poses, each point from where the LiDAR was at the point's own time (add_deskewed()),
/// thinned as they come: memory grows with the map, not with the scans. Throws InputError where the capture has no
/// scans, one cannot be read, or no point has a pose. Thread-safe; the same for any number of threads.
ScanMap map_of_scans(const Capture& capture, const Trajectory& world_T_imu, const ScanMapOptions& options);

}  // namespace cmap
