#include "cmap/render/reconstruction_figure.hpp"

#include <fmt/format.h>

#include <array>

#include "cmap/core/error.hpp"
#include "cmap/render/figure.hpp"
#include "colored_points.hpp"

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
    Layer& layer = layers.emplace_back(points_of(r, *panels[p].placed).layer(blocks[p]));
    layer.title = panels[p].title;
    layer.caption = panels[p].caption;
    layer.classes = classes_of(r);
  }
  FigureOptions options;
  options.width_px = 2100;
  options.height_px = 900;
  const Camera camera = camera_for(View::kTop, blocks.back(), panel_aspect(layers.size(), options), true);
  return draw_figure(layers, camera, options);
}

}  // namespace cmap
