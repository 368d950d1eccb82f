#include "cmap/render/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/render/legend.hpp"
#include "cmap/render/panels.hpp"
#include "names.hpp"

namespace cmap {
namespace {

constexpr double kMargin = 12.0;  // in the pen's units
constexpr int kSmallestPanel = 64;

struct Grid {
  int columns, rows;
};

Grid grid_for(std::size_t n) {
  const int columns = n <= 3 ? static_cast<int>(n) : n == 4 ? 2 : 3;
  return {columns, (static_cast<int>(n) + columns - 1) / columns};
}

Rgba8 ink_on(Background background) {
  return background == Background::kBlack ? Rgba8{235, 235, 235, 255} : Rgba8{20, 20, 20, 255};
}

Rgba8 background_color(Background background) {
  switch (background) {
    case Background::kBlack:
      return {0, 0, 0, 255};
    case Background::kTransparent:
      return {255, 255, 255, 0};
    case Background::kWhite:
      break;
  }
  return {255, 255, 255, 255};
}

}  // namespace

Pen panel_pen(std::size_t n_panels, const FigureOptions& options) {
  const Grid grid = grid_for(n_panels);
  const double unit = std::min(options.width_px / (800.0 * grid.columns), options.height_px / (500.0 * grid.rows));
  return {ink_on(options.background), std::clamp(unit, 0.5, 16.0)};
}

Rect panel_place(std::size_t i, std::size_t n, const FigureOptions& options) {
  const Grid grid = grid_for(n);
  const Pen pen = panel_pen(n, options);
  const int margin = pen.px(kMargin), title = pen.px(kTitleHeight);
  const int width = (options.width_px - (grid.columns + 1) * margin) / grid.columns;
  const int cell = (options.height_px - margin) / grid.rows;
  const int column = static_cast<int>(i) % grid.columns, row = static_cast<int>(i) / grid.columns;
  return {margin + column * (width + margin), row * cell + title, width, cell - title - pen.px(kLegendHeight)};
}

namespace {

/// The points of a map as one camera sees them; serves every layer of that map.
struct Sight {
  PixelMap pixels;
  Array<float> shading;  ///< made when needed
};

PixelMap look_at(const PointBlocks& points, const Projection& projection, const FigureOptions& figure) {
  constexpr double kCloseGaps = 2.0;  // of the spacing, so that random samples of a surface look closed
  constexpr double kLonePoint_px = 7.0;
  const double spacing_m = typical_spacing_m(points);
  SplatOptions options;
  options.point_size_m = figure.point_size * kCloseGaps * spacing_m;
  options.min_size_px = figure.samples * (spacing_m > 0.0 ? 1.0 : kLonePoint_px);
  return figure.splatter(points, projection, options);
}

/// Null for colors that a legend explains: they stay as they are there.
const Array<float>* shading_for(const Layer& layer, const Projection& projection, Sight& sight) {
  constexpr double kStrength = 0.6;
  if (layer.is_heat_map()) return nullptr;
  if (sight.shading.empty()) sight.shading = eye_dome_shading(sight.pixels, projection, kStrength);
  return &sight.shading;
}

/// Colors, shades and averages the samples of every pixel.
void paint(Image& image, const Rect& place, const Layer& layer, const PixelMap& pixels, const Array<float>* shading) {
  const auto samples_wide = static_cast<std::size_t>(pixels.width);
  const auto samples = samples_wide / static_cast<std::size_t>(place.width);
  parallel_chunks(static_cast<std::size_t>(place.height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      for (std::size_t x = 0; x < static_cast<std::size_t>(place.width); ++x) {
        float sum[3] = {0.0f, 0.0f, 0.0f};
        std::size_t covered = 0;
        for (std::size_t s = 0; s < samples * samples; ++s) {
          const std::size_t cell = (y * samples + s / samples) * samples_wide + x * samples + s % samples;
          if (pixels.is_empty(cell)) continue;
          const Rgb8& color = layer.colors[pixels.slot(cell)];
          const float light = shading == nullptr ? 1.0f : (*shading)[cell];
          for (std::size_t c = 0; c < 3; ++c) sum[c] += light * static_cast<float>(color[c]);
          ++covered;
        }
        if (covered == 0) continue;
        Rgba8 mean{0, 0, 0, static_cast<std::uint8_t>(255 * covered / (samples * samples))};
        for (std::size_t c = 0; c < 3; ++c) {
          mean[c] = static_cast<std::uint8_t>(sum[c] / static_cast<float>(covered) + 0.5f);
        }
        blend(image, place.x + static_cast<int>(x), place.y + static_cast<int>(y), mean);
      }
    }
  });
}

void check_size(std::size_t n_layers, const FigureOptions& options) {
  const auto refuse = [&](const char* reason) {
    throw UsageError(fmt::format("a figure of {} x {} pixels {}", options.width_px, options.height_px, reason));
  };
  if (options.width_px > kMostPixels || options.height_px > kMostPixels) refuse("is too large: at most 16384 a side");
  if (options.width_px < 1 || options.height_px < 1) refuse("is no picture");
  const Rect place = panel_place(0, n_layers, options);
  if (place.width < kSmallestPanel || place.height < kSmallestPanel) refuse("has no room for its panels");
}

}  // namespace

Background background_from_name(std::string_view name) {
  return value_of_name<Background>(
      "background", name,
      {{"white", Background::kWhite}, {"black", Background::kBlack}, {"transparent", Background::kTransparent}});
}

double panel_aspect(std::size_t n_layers, const FigureOptions& options) {
  check_size(n_layers, options);
  const Rect place = panel_place(0, n_layers, options);
  return static_cast<double>(place.width) / place.height;
}

Image draw_figure(std::span<const Layer> layers, const Camera& camera, const FigureOptions& options) {
  check_size(layers.size(), options);
  Image image(options.width_px, options.height_px, background_color(options.background));
  const Pen pen = panel_pen(layers.size(), options);
  const Rect first = panel_place(0, layers.size(), options);
  const Projection projection(camera, options.samples * first.width, options.samples * first.height);
  // True at the depth of what the camera looks at.
  const double meters_per_px = options.samples * projection.meters_per_pixel((camera.target - camera.position).norm());
  std::map<const PointBlocks*, Sight> sights;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Layer& layer = layers[i];
    const Rect place = panel_place(i, layers.size(), options);
    const auto [place_of_sight, is_new] = sights.try_emplace(layer.points);
    Sight& sight = place_of_sight->second;
    if (is_new) sight.pixels = look_at(*layer.points, projection, options);
    paint(image, place, layer, sight.pixels, shading_for(layer, projection, sight));
    draw_title(image, place, layer, pen);
    draw_legend(image, place, layer, pen);
    draw_scale_bar(image, place, meters_per_px, pen);
  }
  return image;
}

}  // namespace cmap
