#include "color/color_levels.hpp"

namespace cmap {

const Levels& color_distance_levels(LevelInputs& levels) {
  if (!levels.color_distance) {
    const auto same = [](const Eigen::Vector3d& color) { return color; };
    const auto distance = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).norm() / 255.0; };
    levels.color_distance = difference_levels(levels, levels.inputs.options().color_max_distance_m, same, distance);
  }
  return *levels.color_distance;
}

}  // namespace cmap
