#include "cmap/render/lidar_mapping_figure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cmap/render/figure.hpp"
#include "colored_points.hpp"

namespace cmap {
namespace {

constexpr Rgb8 kPath{20, 20, 20}, kPredicted{255, 30, 30}, kLoop{0, 150, 60};

/// Heights from the lowest to the highest 2 %: a few strays must not take the colors.
ColorScale height_scale(const PointCloud& map) {
  std::vector<float> heights;
  for (std::size_t i = 0; i < map.size(); i += 1 + map.size() / 100000) heights.push_back(map.positions[i].z());
  ColorScale scale;
  scale.unit = "m";
  if (heights.empty()) return scale;
  std::ranges::sort(heights);
  const auto at = [&](double share) {
    return map.origin.z() +
           static_cast<double>(heights[static_cast<std::size_t>(share * static_cast<double>(heights.size() - 1))]);
  };
  scale.low = at(0.02);
  scale.high = std::max(at(0.98), scale.low + 0.1);
  return scale;
}

void add_path(const LidarMapping& mapping, ColoredPoints& points) {
  for (std::size_t i = 1; i < mapping.scan_ends.size(); ++i) {
    const bool predicted = mapping.scans[i].outcome == ScanOutcome::kPredicted;
    points.add_line(mapping.scan_ends[i - 1].position, mapping.scan_ends[i].position, predicted ? kPredicted : kPath);
  }
}

void add_loops(const LidarMapping& mapping, ColoredPoints& points) {
  if (!mapping.loops) return;
  for (const LoopCandidate& loop : mapping.loops->candidates) {
    if (!loop.accepted) continue;
    points.add_line(mapping.loops->poses[loop.from].translation(), mapping.loops->poses[loop.to].translation(), kLoop);
  }
}

}  // namespace

Image draw_lidar_mapping(const LidarMapping& mapping) {
  const ColorScale scale = height_scale(mapping.map);
  ColoredPoints points;
  for (std::size_t i = 0; i < mapping.map.size(); ++i) {
    const Eigen::Vector3d world = mapping.map.world(i);
    points.add(world, color_of(world.z(), scale));
  }
  add_path(mapping, points);
  add_loops(mapping, points);
  PointBlocks blocks;
  Layer layer = points.layer(blocks);
  layer.title = "map and path";
  layer.caption = fmt::format("{} scans, {:.1f} m", mapping.scan_ends.size(), mapping.summary.path_m);
  layer.scale = scale;
  const std::vector<Layer> layers{layer};
  const FigureOptions options;
  return draw_figure(layers, camera_for(View::kTop, blocks, panel_aspect(1, options), true), options);
}

}  // namespace cmap
