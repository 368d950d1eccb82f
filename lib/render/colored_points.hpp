#pragma once

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/render/layer.hpp"
#include "cmap/spatial/point_blocks.hpp"

namespace cmap {

/// Points and their colors, before they are sorted.
struct ColoredPoints {
  PointCloud cloud;
  Array<Rgb8> colors;

  void add(const Eigen::Vector3d& world, Rgb8 color) {
    if (cloud.positions.empty()) cloud.origin = choose_origin({world, world});
    cloud.positions.push_back((world - cloud.origin).cast<float>());
    colors.push_back(color);
  }
  /// Dots every 10 cm, so high above that nothing hides them from above.
  void add_line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Rgb8 color) {
    constexpr double kStep_m = 0.1, kAbove_m = 100.0;
    const auto n = static_cast<int>((to - from).norm() / kStep_m) + 1;
    for (int i = 0; i <= n; ++i) add(from + (to - from) * i / n + Eigen::Vector3d(0, 0, kAbove_m), color);
  }
  /// A layer that shows them; `blocks` must outlive it.
  Layer layer(PointBlocks& blocks) const {
    blocks = sort_points(cloud);
    Layer layer;
    layer.points = &blocks;
    layer.colors.resize(blocks.size);
    for (std::size_t slot = 0; slot < blocks.size; ++slot) layer.colors[slot] = colors[blocks.original_index[slot]];
    return layer;
  }
};

}  // namespace cmap
