#pragma once

#include "cmap/align/align.hpp"
#include "cmap/align/icp.hpp"

namespace cmap {

/// Iterative closest points coarse to fine, whatever they minimize.
inline IcpOptions icp_options(const AlignOptions& options, double voxel_m) {
  constexpr double kGateVoxels = 10.0;
  IcpOptions how;
  how.with_scale = options.with_scale;
  how.levels = coarse_to_fine(voxel_m, options.max_distance_m.value_or(kGateVoxels * voxel_m), 100);
  for (IcpLevel& level : how.levels) level.most_points = options.most_points;
  return how;
}

/// By one metric.
inline Alignment run_icp(const PointCloud& source, const PointCloud& target, const AlignOptions& options,
                         double voxel_m, IcpMetric metric) {
  IcpOptions how = icp_options(options, voxel_m);
  how.metric = metric;
  return icp(source, target, options.T_initial, how);
}

}  // namespace cmap
