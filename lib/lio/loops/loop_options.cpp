#include "cmap/lio/loop_options.hpp"

#include <Eigen/Geometry>

#include "loops/loop_fields.hpp"

namespace cmap {
namespace {

constexpr double kIndoorExtent_m = 60.0;

}  // namespace

LoopOptions indoor_loop_options() {
  LoopOptions options;
  options.submap_m = 4.0;
  options.submap_spacing_m = 1.0;
  options.voxel_m = 0.15;
  options.revisit_m = 5.0;
  options.min_path_m = 12.0;
  options.drift_m = 0.5;
  options.max_drift_m = 10.0;
  options.reach_m = 20.0;
  options.largest_error_m = 0.1;
  options.loop_sigma_m = 0.02;
  return options;
}

LoopOptions loop_options_for(std::span<const Keyframe> keyframes) {
  Eigen::AlignedBox3d box;
  for (const Keyframe& keyframe : keyframes) box.extend(keyframe.T_world_body.translation());
  const bool is_indoor = !box.isEmpty() && box.sizes().head<2>().norm() < kIndoorExtent_m;
  return is_indoor ? indoor_loop_options() : LoopOptions{};
}

void check_options(const LoopOptions& options) {
  LoopOptions copy = options;
  check_options(option_fields(copy), "loops");
}

}  // namespace cmap
