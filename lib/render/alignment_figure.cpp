#include "cmap/render/alignment_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "cmap/geometry/order_statistics.hpp"
#include "cmap/render/figure.hpp"
#include "cmap/spatial/nearest.hpp"

namespace cmap {
namespace {

// Told apart by the color-blind, too, and on white.
constexpr Rgb8 kTargetColor{44, 98, 160}, kSourceColor{230, 126, 34};

PointCloud together(const PointCloud& target, const PointCloud& moved) {
  PointCloud both = target;
  const Eigen::Vector3d shift = moved.origin - target.origin;
  for (const Eigen::Vector3f& p : moved.positions) both.positions.push_back((p.cast<double>() + shift).cast<float>());
  return both;
}

/// Lighter from low to high, so that what stands on the ground is seen from above.
Rgb8 shaded(Rgb8 color, double height) {
  const double light = 0.6 * std::clamp(height, 0.0, 1.0);
  for (std::uint8_t& c : color) c = static_cast<std::uint8_t>(0.7 * c + light * (255 - 0.7 * c));
  return color;
}

/// The panels, and the points that they show.
struct Panels {
  std::deque<PointBlocks> points;
  std::vector<Layer> layers;

  Layer& add(std::string title, std::string caption, const PointCloud& cloud) {
    points.push_back(sort_points(cloud));
    Layer& layer = layers.emplace_back();
    layer.title = std::move(title);
    layer.caption = std::move(caption);
    layer.points = &points.back();
    layer.colors.resize(points.back().size);
    return layer;
  }

  void add_both(std::string title, std::string caption, const PointCloud& target, const PointCloud& moved) {
    Layer& layer = add(std::move(title), std::move(caption), together(target, moved));
    const Box3d box = box_to_show(*layer.points);
    const double low_m = box.min.z(), range_m = std::max(box.max.z() - low_m, 1e-9);
    for (std::size_t slot = 0; slot < layer.colors.size(); ++slot) {
      const Rgb8 color = layer.points->original_index[slot] < target.size() ? kTargetColor : kSourceColor;
      layer.colors[slot] = shaded(color, (layer.points->world(slot).z() - low_m) / range_m);
    }
    layer.classes = {{"DST", kTargetColor}, {"SRC", kSourceColor}};
  }
};

/// The scale ends where 95 % of the distances do, but at what counted as a match at most.
void add_distances(const Bvh& target, const PointCloud& moved, double max_distance_m, Panels& panels) {
  constexpr double kShown = 0.95;
  Layer& layer = panels.add("distance of SRC to DST", "", moved);
  const NearestField nearest = find_nearest(target, *layer.points);
  std::vector<double> distances_m(layer.colors.size());
  for (std::size_t i = 0; i < distances_m.size(); ++i) distances_m[i] = std::sqrt(nearest.sq_dist[i]);
  std::vector<double> ordered = distances_m;
  ColorScale scale{.unit = "m"};
  scale.high = value_at_rank(ordered, static_cast<std::size_t>(kShown * static_cast<double>(ordered.size() - 1)));
  if (max_distance_m > 0.0) scale.high = std::min(scale.high, max_distance_m);
  if (!(scale.high > 0.0)) scale.high = 1.0;
  for (std::size_t i = 0; i < distances_m.size(); ++i) layer.colors[i] = color_of(distances_m[i], scale);
  layer.scale = scale;
}

Eigen::Vector3d center_of(const Box3d& box) { return 0.5 * (box.min + box.max); }

/// Before the alignment, in view of what is shown of the target.
void add_before(const Box3d& shown, const PointCloud& target, PointCloud before, Panels& panels) {
  const Eigen::Vector3d apart = center_of(box_to_show(sort_points(before))) - center_of(shown);
  std::string caption = "as given";
  if (apart.norm() > (shown.max - shown.min).norm()) {
    before.origin -= apart;
    caption = fmt::format("SRC is {:.3g} m away, shown moved here", apart.norm());
  }
  panels.add_both("before", std::move(caption), target, before);
}

}  // namespace

Image draw_alignment(const AlignmentPicture& picture) {
  const Alignment& found = picture.alignment;
  const Judgment& judgment = found.judgment;
  constexpr std::size_t kMostShown = 500'000;
  const PointCloud target = sampled(picture.target, kMostShown), source = sampled(picture.source, kMostShown);
  const PointCloud moved = transformed(source, found.T_dst_src);
  const Bvh index(sort_points(target));
  Panels panels;
  add_before(box_to_show(index.points), target, transformed(source, picture.T_initial), panels);
  panels.add_both(fmt::format("after: {}", name_of(judgment.verdict, verdict_names())),
                  fmt::format("score {:.3g}", judgment.score), target, moved);
  const PointBlocks& after = panels.points.back();
  add_distances(index, moved, found.max_distance_m, panels);
  if (!judgment.rivals.empty()) {
    const RivalPose& rival = judgment.rivals.front();
    panels.add_both("second-best answer", fmt::format("score {:.3g}", rival.score), target,
                    transformed(source, rival.T_dst_src));
  }
  FigureOptions options;
  const bool two_rows = panels.layers.size() > 3;
  options.width_px = two_rows ? 1400 : 2100;
  options.height_px = two_rows ? 1500 : 800;
  return draw_figure(panels.layers, camera_for(View::kTop, after, panel_aspect(panels.layers.size(), options), true),
                     options);
}

void write_alignment_figure(const AlignmentPicture& picture, const std::filesystem::path& name, OutputFile& file) {
  write_image(draw_alignment(picture), name, file);
}

}  // namespace cmap
