#pragma once

#include <fmt/format.h>

#include <algorithm>

#include "cmap/core/warning.hpp"
#include "cmap/metrics/metric_inputs.hpp"
#include "cmap/metrics/record.hpp"

namespace cmap {

/// The distances of the voxels that both maps fill, of one phase of the grid; at the world's origin the first.
inline std::span<const VoxelDistance> wasserstein_voxels(const MetricInputs& inputs, std::size_t phase = 0) {
  return inputs.wasserstein->by_phase[phase];
}

/// Makes the Gaussians of the voxels that both maps fill and their distances, unless they are there.
inline void prepare_wasserstein(MetricInputs& inputs) {
  if (inputs.wasserstein) return;
  const MetricOptions& o = inputs.options();
  inputs.wasserstein = voxel_wasserstein(*inputs.pair, phase_options(o, o.awd_voxel_m, o.awd_min_points));
}

/// Said once, whichever of the two metrics is asked for.
inline void warn_of_no_voxels(const MetricInputs& inputs, std::vector<Warning>& warnings) {
  constexpr const char* kId = "average_wasserstein_no_voxels";
  if (!wasserstein_voxels(inputs).empty() || std::ranges::count(warnings, kId, &Warning::id) > 0) return;
  warnings.push_back({kId, fmt::format("no {} m voxel holds {} points of both maps: no AWD and no SCS",
                                       inputs.options().awd_voxel_m, inputs.options().awd_min_points)});
}

inline std::vector<Number> wasserstein_parameters(const MetricOptions& options) {
  return {{"voxel_m", options.awd_voxel_m}, {"min_points", options.awd_min_points}};
}

}  // namespace cmap
