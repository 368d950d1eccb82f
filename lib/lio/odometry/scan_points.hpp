#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "cmap/geometry/lidar_scan.hpp"
#include "cmap/lio/odometry_options.hpp"

namespace cmap {

/// A scan's points within range, every one in the LiDAR frame at its own time, and when that was.
struct ScanPoints {
  std::vector<Eigen::Vector3f> positions;
  std::vector<float> before_end_s;    ///< from the point's time to end_s, not negative
  double begin_s = 0.0, end_s = 0.0;  ///< times of its first and its last point
  std::size_t n_measured = 0;         ///< points of the scan, those out of range too
};

/// Points that are not finite or out of range are left out. A scan without times, or all of whose times are equal, is
/// one instant; its end is the latest time of its points, those left out too, so that the end does not wander.
ScanPoints scan_points(const LidarScan& scan, const OdometryOptions& options);

/// Indices of the first point in each voxel of that size, in order; of these at most `most`, evenly.
std::vector<std::uint32_t> thinned(const std::vector<Eigen::Vector3f>& points, double voxel_m, std::size_t most);

}  // namespace cmap
