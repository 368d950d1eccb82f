#include "cmap/render/reconstruction_figure.hpp"

#include <fmt/format.h>

#include <array>

#include "cmap/core/error.hpp"
#include "cmap/render/figure.hpp"

namespace cmap {
namespace {

/// Colors of sessions, told apart also by the color-blind (Tol's muted palette); they repeat.
constexpr std::array<Rgb8, 9> kSessionColors{{{51, 34, 136},
                                              {221, 204, 119},
                                              {17, 119, 51},
                                              {204, 102, 119},
                                              {136, 204, 238},
                                              {136, 34, 85},
                                              {68, 170, 153},
                                              {153, 153, 51},
                                              {170, 68, 153}}};
constexpr Rgb8 kCamera{20, 20, 20}, kLink{255, 30, 30};

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
};

ColoredPoints points_of(const Reconstruction& r, const std::vector<PlacedSession>& placed) {
  ColoredPoints points;
  for (std::size_t k = 0; k < placed.size(); ++k) {
    const SessionSketch& sketch = r.sketches[k];
    for (std::size_t i = 0; i < sketch.positions.size(); ++i) {
      const Eigen::Vector3d camera_m = placed[k].scale * sketch.positions[i].cast<double>();
      points.add(placed[k].T_world_camera[sketch.frame[i]] * camera_m, kSessionColors[k % kSessionColors.size()]);
    }
    for (std::size_t i = 1; i < placed[k].T_world_camera.size(); ++i) {
      points.add_line(placed[k].T_world_camera[i - 1].translation(), placed[k].T_world_camera[i].translation(),
                      kCamera);
    }
  }
  for (const SessionLink& link : r.links) {
    points.add_line(placed[link.from].T_world_camera[link.from_frame].translation(),
                    placed[link.to].T_world_camera[link.to_frame].translation(), kLink);
  }
  return points;
}

std::vector<ColorClass> classes_of(const Reconstruction& r) {
  constexpr std::size_t kMostInLegend = 6;
  std::vector<ColorClass> classes;
  if (r.poses.size() > kMostInLegend) return classes;
  for (std::size_t k = 0; k < r.poses.size(); ++k) {
    classes.push_back({fmt::format("session {}", r.poses[k].index), kSessionColors[k]});
  }
  return classes;
}

}  // namespace

Image draw_reconstruction(const Reconstruction& r) {
  if (r.sketches.empty()) throw UnsupportedError("the figure of a reconstruction needs its fusion");
  struct Panel {
    const char* title;
    std::string caption;
    const std::vector<PlacedSession>* placed;
  };
  std::vector<Panel> panels{{"after pre-fusion", "", &r.prefusion}};
  if (!r.registration.empty()) panels.push_back({"after registration", "", &r.registration});
  panels.push_back({"final", fmt::format("largest correction {:.2f} m", r.graph.largest_correction_m), &r.poses});
  std::vector<PointBlocks> blocks(panels.size());
  std::vector<Layer> layers;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const ColoredPoints points = points_of(r, *panels[p].placed);
    blocks[p] = sort_points(points.cloud);
    Layer& layer = layers.emplace_back();
    layer.title = panels[p].title;
    layer.caption = panels[p].caption;
    layer.points = &blocks[p];
    layer.colors.resize(blocks[p].size);
    for (std::size_t slot = 0; slot < blocks[p].size; ++slot) {
      layer.colors[slot] = points.colors[blocks[p].original_index[slot]];
    }
    layer.classes = classes_of(r);
  }
  FigureOptions options;
  options.width_px = 2100;
  options.height_px = 900;
  const Camera camera = camera_for(View::kTop, blocks.back(), panel_aspect(layers.size(), options), true);
  return draw_figure(layers, camera, options);
}

}  // namespace cmap
