#pragma once

#include "cmap/align/align.hpp"
#include "cmap/align/icp.hpp"

namespace cmap {

/// Iterative closest points coarse to fine, by one metric.
inline Alignment run_icp(const PointCloud& source, const PointCloud& target, const AlignOptions& options,
                         double voxel_m, IcpMetric metric) {
  constexpr double kGateVoxels = 10.0;
  IcpOptions icp_options;
  icp_options.metric = metric;
  icp_options.with_scale = options.with_scale;
  icp_options.levels = coarse_to_fine(voxel_m, options.max_distance_m.value_or(kGateVoxels * voxel_m), 100);
  return icp(source, target, options.T_initial, icp_options);
}

}  // namespace cmap
