#include "cmap/render/figure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

constexpr int kSamples = 2;  // an axis and pixel
constexpr int kTextSize = 18, kSmallTextSize = 14;
constexpr int kMargin = 12, kTitleHeight = 32, kLegendHeight = 44;
constexpr int kSmallestPanel = 64;

struct Rect {
  int x, y, width, height;
};

struct Grid {
  int columns, rows;
};

Grid grid_for(std::size_t n) {
  const int columns = n <= 3 ? static_cast<int>(n) : n == 4 ? 2 : 3;
  return {columns, (static_cast<int>(n) + columns - 1) / columns};
}

/// The picture of panel i; its title stands above and its legend below.
Rect picture_of(std::size_t i, std::size_t n, const FigureOptions& options) {
  const Grid grid = grid_for(n);
  const int width = (options.width_px - (grid.columns + 1) * kMargin) / grid.columns;
  const int cell = (options.height_px - kMargin) / grid.rows;
  const int column = static_cast<int>(i) % grid.columns, row = static_cast<int>(i) / grid.columns;
  return {kMargin + column * (width + kMargin), row * cell + kTitleHeight, width, cell - kTitleHeight - kLegendHeight};
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

Rgba8 ink_on(Background background) {
  return background == Background::kBlack ? Rgba8{235, 235, 235, 255} : Rgba8{20, 20, 20, 255};
}

/// The points of a map as one camera sees them; serves every layer of that map.
struct Sight {
  PixelMap pixels;
  Array<float> shading_of_colors, shading_of_heat_maps;  ///< made when needed
};

PixelMap look_at(const PointBlocks& points, const Projection& projection, double point_size) {
  constexpr double kCloseGaps = 2.0;  // of the spacing, so that random samples of a surface look closed
  constexpr double kLonePoint_px = 7.0;
  const double spacing_m = typical_spacing_m(points);
  SplatOptions options;
  options.point_size_m = point_size * kCloseGaps * spacing_m;
  options.min_size_px = spacing_m > 0.0 ? kSamples : kSamples * kLonePoint_px;
  return splat(points, projection, options);
}

const Array<float>& shading_for(const Layer& layer, const Projection& projection, Sight& sight) {
  constexpr double kStrong = 0.6, kWeak = 0.35;  // heat maps must stay readable
  Array<float>& shading = layer.is_heat_map() ? sight.shading_of_heat_maps : sight.shading_of_colors;
  if (shading.empty()) {
    shading = eye_dome_shading(sight.pixels, projection, layer.is_heat_map() ? kWeak : kStrong);
  }
  return shading;
}

/// Colors, shades and averages the samples of every pixel.
void paint(Image& image, const Rect& place, const Layer& layer, const PixelMap& pixels, const Array<float>& shading) {
  const auto samples_wide = static_cast<std::size_t>(pixels.width);
  parallel_chunks(static_cast<std::size_t>(place.height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      for (std::size_t x = 0; x < static_cast<std::size_t>(place.width); ++x) {
        float sum[3] = {0.0f, 0.0f, 0.0f};
        int covered = 0;
        for (std::size_t s = 0; s < kSamples * kSamples; ++s) {
          const std::size_t cell = (y * kSamples + s / kSamples) * samples_wide + x * kSamples + s % kSamples;
          if (pixels.is_empty(cell)) continue;
          const Rgb8& color = layer.colors[pixels.slot(cell)];
          for (std::size_t c = 0; c < 3; ++c) sum[c] += shading[cell] * static_cast<float>(color[c]);
          ++covered;
        }
        if (covered == 0) continue;
        Rgba8 mean{0, 0, 0, static_cast<std::uint8_t>(255 * covered / (kSamples * kSamples))};
        for (std::size_t c = 0; c < 3; ++c) {
          mean[c] = static_cast<std::uint8_t>(sum[c] / static_cast<float>(covered) + 0.5f);
        }
        blend(image, place.x + static_cast<int>(x), place.y + static_cast<int>(y), mean);
      }
    }
  });
}

/// 1, 2 or 5 times a power of ten, at most `value`.
double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  return value >= 5.0 * power ? 5.0 * power : value >= 2.0 * power ? 2.0 * power : power;
}

std::string length_label(double meters) {
  if (meters >= 1000.0) return fmt::format("{:g} km", meters / 1000.0);
  if (meters >= 1.0) return fmt::format("{:g} m", meters);
  if (meters >= 0.01) return fmt::format("{:g} cm", meters * 100.0);
  return fmt::format("{:g} mm", meters * 1000.0);
}

/// A scale bar, exact at the depth of what the camera looks at.
void draw_scale_bar(Image& image, const Rect& place, const Camera& camera, const Projection& projection, Rgba8 ink) {
  const double depth = (camera.target - camera.position).norm();
  const double meters_per_px = kSamples * projection.meters_per_pixel(depth);
  const double length = round_down(0.22 * place.width * meters_per_px);
  const int width = static_cast<int>(std::lround(length / meters_per_px));
  const int y = place.y + place.height + 14;
  fill(image, place.x, y, width, 2, ink);
  fill(image, place.x, y - 4, 2, 10, ink);
  fill(image, place.x + width - 2, y - 4, 2, 10, ink);
  draw_text(image, place.x, y + 16, length_label(length), kSmallTextSize, ink);
}

double value_at(const ColorScale& scale, double share) {
  if (!scale.logarithmic) return scale.low + share * (scale.high - scale.low);
  return std::exp(std::log(scale.low) + share * (std::log(scale.high) - std::log(scale.low)));
}

void draw_color_bar(Image& image, const Rect& place, const ColorScale& scale, Rgba8 ink) {
  const int width = static_cast<int>(0.45 * place.width), height = 14;
  const int left = place.x + place.width - width - 70, top = place.y + place.height + 6;
  for (int x = 0; x < width; ++x) {
    const Rgb8 color = color_of(value_at(scale, (x + 0.5) / width), scale);
    fill(image, left + x, top, 1, height, {color[0], color[1], color[2], 255});
  }
  for (double share : {0.0, 0.5, 1.0}) {
    const int x = left + static_cast<int>(std::lround(share * (width - 1)));
    fill(image, x, top + height, 1, 4, ink);
    draw_text(image, x, top + height + 13, fmt::format("{:.3g}", value_at(scale, share)), kSmallTextSize, ink,
              TextAnchor::kCenter);
  }
  draw_text(image, left + width + 8, top + height / 2, scale.unit, kSmallTextSize, ink);
}

void draw_classes(Image& image, const Rect& place, const std::vector<ColorClass>& classes, Rgba8 ink) {
  constexpr int kSwatch = 14, kGap = 18;
  const int y = place.y + place.height + 14;
  int right = place.x + place.width;
  for (auto item = classes.rbegin(); item != classes.rend(); ++item) {
    draw_text(image, right, y, item->label, kSmallTextSize, ink, TextAnchor::kRight);
    const int left = right - text_width(item->label, kSmallTextSize) - 6 - kSwatch;
    fill(image, left, y - kSwatch / 2, kSwatch, kSwatch, {item->color[0], item->color[1], item->color[2], 255});
    right = left - kGap;
  }
}

void check_size(std::size_t n_layers, const FigureOptions& options) {
  const auto refuse = [&](const char* reason) {
    throw UsageError(fmt::format("a figure of {} x {} pixels {}", options.width_px, options.height_px, reason));
  };
  if (options.width_px > kMostPixels || options.height_px > kMostPixels) refuse("is too large: at most 16384 a side");
  if (options.width_px < 1 || options.height_px < 1) refuse("is no picture");
  const Rect place = picture_of(0, n_layers, options);
  if (place.width < kSmallestPanel || place.height < kSmallestPanel) refuse("has no room for its panels");
}

}  // namespace

Background background_from_name(std::string_view name) {
  if (name == "white") return Background::kWhite;
  if (name == "black") return Background::kBlack;
  if (name == "transparent") return Background::kTransparent;
  throw UsageError(fmt::format("background \"{}\" is none of white, black, transparent", name));
}

double panel_aspect(std::size_t n_layers, const FigureOptions& options) {
  check_size(n_layers, options);
  const Rect place = picture_of(0, n_layers, options);
  return static_cast<double>(place.width) / place.height;
}

Image draw_figure(std::span<const Layer> layers, const Camera& camera, const FigureOptions& options) {
  check_size(layers.size(), options);
  Image image(options.width_px, options.height_px, background_color(options.background));
  const Rgba8 ink = ink_on(options.background);
  const Rect first = picture_of(0, layers.size(), options);
  const Projection projection(camera, kSamples * first.width, kSamples * first.height);
  std::map<const PointBlocks*, Sight> sights;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Layer& layer = layers[i];
    const Rect place = picture_of(i, layers.size(), options);
    const auto [place_of_sight, is_new] = sights.try_emplace(layer.points);
    Sight& sight = place_of_sight->second;
    if (is_new) sight.pixels = look_at(*layer.points, projection, options.point_size);
    paint(image, place, layer, sight.pixels, shading_for(layer, projection, sight));
    draw_text(image, place.x, place.y - kTitleHeight / 2, layer.title, kTextSize, ink);
    draw_text(image, place.x + place.width, place.y - kTitleHeight / 2, layer.caption, kTextSize, ink,
              TextAnchor::kRight);
    draw_scale_bar(image, place, camera, projection, ink);
    if (layer.scale) draw_color_bar(image, place, *layer.scale, ink);
    draw_classes(image, place, layer.classes, ink);
  }
  return image;
}

}  // namespace cmap
