#pragma once

#include "cmap/metrics/metric_inputs.hpp"
#include "cmap/metrics/record.hpp"

namespace cmap {

/// Makes the Gaussians of the voxels that both maps fill and their distances, unless they are there.
inline void prepare_wasserstein(MetricInputs& inputs) {
  if (inputs.gaussians) return;
  const MetricOptions& o = inputs.options();
  inputs.gaussians = gaussian_pairs(*inputs.pair, o.awd_voxel_m, o.awd_min_points);
  inputs.wasserstein = wasserstein_distances(*inputs.gaussians);
}

inline std::vector<Number> wasserstein_parameters(const MetricOptions& options) {
  return {{"voxel_m", options.awd_voxel_m}, {"min_points", options.awd_min_points}};
}

}  // namespace cmap
