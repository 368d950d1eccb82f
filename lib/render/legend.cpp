#include "cmap/render/legend.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace cmap {
namespace {

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

double value_at(const ColorScale& scale, double share) {
  if (!scale.logarithmic) return scale.low + share * (scale.high - scale.low);
  return std::exp(std::log(scale.low) + share * (std::log(scale.high) - std::log(scale.low)));
}

void draw_color_bar(Image& image, const Rect& place, const ColorScale& scale, const Pen& pen) {
  const int unit_width = pen.px(8) + text_width(scale.unit, pen.small_text_px());
  const int width = place.width / 2, height = pen.px(14);
  const int left = place.x + place.width - width - unit_width, top = place.y + place.height + pen.px(6);
  for (int x = 0; x < width; ++x) {
    const Rgb8 color = color_of(value_at(scale, (x + 0.5) / width), scale);
    fill(image, left + x, top, 1, height, {color[0], color[1], color[2], 255});
  }
  for (double share : {0.0, 0.5, 1.0}) {
    const int x = left + static_cast<int>(std::lround(share * (width - 1)));
    fill(image, x, top + height, pen.px(1), pen.px(4), pen.ink);
    draw_text(image, x, top + height + pen.px(14), fmt::format("{:.3g}", value_at(scale, share)), pen.small_text_px(),
              pen.ink, TextAnchor::kCenter);
  }
  draw_text(image, left + width + pen.px(8), top + height / 2, scale.unit, pen.small_text_px(), pen.ink);
}

void draw_classes(Image& image, const Rect& place, const std::vector<ColorClass>& classes, const Pen& pen) {
  const int swatch = pen.px(14), y = place.y + place.height + pen.px(14);
  int right = place.x + place.width;
  for (auto item = classes.rbegin(); item != classes.rend(); ++item) {
    draw_text(image, right, y, item->label, pen.small_text_px(), pen.ink, TextAnchor::kRight);
    const int left = right - text_width(item->label, pen.small_text_px()) - pen.px(6) - swatch;
    fill(image, left, y - swatch / 2, swatch, swatch, {item->color[0], item->color[1], item->color[2], 255});
    right = left - pen.px(18);
  }
}

}  // namespace

void draw_title(Image& image, const Rect& place, const Layer& layer, const Pen& pen) {
  const int y = place.y - pen.px(kTitleHeight / 2.0);
  draw_text(image, place.x, y, layer.title, pen.text_px(), pen.ink);
  draw_text(image, place.x + place.width, y, layer.caption, pen.text_px(), pen.ink, TextAnchor::kRight);
}

void draw_legend(Image& image, const Rect& place, const Layer& layer, const Pen& pen) {
  if (layer.scale) draw_color_bar(image, place, *layer.scale, pen);
  draw_classes(image, place, layer.classes, pen);
}

void draw_scale_bar(Image& image, const Rect& place, double meters_per_px, const Pen& pen) {
  const double length = round_down(0.22 * place.width * meters_per_px);
  const int width = static_cast<int>(std::lround(length / meters_per_px));
  const int y = place.y + place.height - pen.px(8), line = pen.px(2);
  const auto draw = [&](int dx, int dy, Rgba8 color) {
    const int left = place.x + dx, top = y + dy;
    fill(image, left, top, width, line, color);
    fill(image, left, top - pen.px(4), line, pen.px(10), color);
    fill(image, left + width - line, top - pen.px(4), line, pen.px(10), color);
    draw_text(image, left, top - pen.px(14), length_label(length), pen.small_text_px(), color);
  };
  // An outline, where the map lies below.
  const auto paper = static_cast<std::uint8_t>(pen.ink[0] < 128 ? 255 : 0);
  for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
    draw(dx * pen.px(1), dy * pen.px(1), {paper, paper, paper, 255});
  }
  draw(0, 0, pen.ink);
}

}  // namespace cmap
