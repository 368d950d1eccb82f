#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "cmap/geometry/lidar_scan.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/capture.hpp"

namespace cmap {

struct LidarMapOptions {
  double voxel_m = 0.1;      ///< the map is thinned to this
  double min_range_m = 0.5;  ///< nearer returns are the carrier's own
  double margin_s = 1.0;     ///< scans this long before and after a session belong to it
};

/// Appends a scan's points in the world, each moved from where the LiDAR was at the point's own time: positions linear
/// between poses, rotations along the shortest arc. Points at times without a pose are left out. An empty cloud gets
/// its origin from the first point.
void add_deskewed(const LidarScan& scan, const Trajectory& world_T_imu, const Eigen::Isometry3d& T_imu_lidar,
                  const LidarMapOptions& options, double max_gap_s, PointCloud& cloud);

/// The scans of a capture from first_s to last_s, margins added, as one map in the world frame.
struct LidarMap {
  PointCloud cloud;          ///< thinned; no color
  std::size_t n_scans = 0;   ///< that belong to this time
  std::size_t n_points = 0;  ///< of these scans
  std::size_t n_placed = 0;  ///< of these, those with a pose and outside min_range_m
};

/// Throws InputError where a scan cannot be read. An empty cloud where no scan or pose belongs to this time.
/// Thread-safe.
/// @param max_gap_s  poses farther apart are not interpolated between
LidarMap lidar_map(const Capture& capture, double first_s, double last_s, const LidarMapOptions& options,
                   double max_gap_s = 0.15);

}  // namespace cmap
