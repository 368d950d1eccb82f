#include "viewer_marks.hpp"

#include <cmath>

namespace cmap {

void draw_text_box(Image& image, int x, int y, TextAnchor anchor, std::span<const std::string> lines, const Pen& pen) {
  const int padding = pen.px(8), line_height = pen.px(20);
  int width = 0;
  for (const std::string& line : lines) width = std::max(width, text_width(line, pen.small_text_px()));
  width += 2 * padding;
  if (anchor == TextAnchor::kRight) x -= width;
  const bool dark_ink = pen.ink[0] < 128;
  const auto paper = static_cast<std::uint8_t>(dark_ink ? 240 : 25);
  fill(image, x, y, width, static_cast<int>(lines.size()) * line_height + padding, {paper, paper, paper, 225});
  int middle = y + (padding + line_height) / 2;
  for (const std::string& line : lines) {
    draw_text(image, x + padding, middle, line, pen.small_text_px(), pen.ink);
    middle += line_height;
  }
}

void draw_ring(Image& image, int x, int y, const Pen& pen) {
  const double outer = pen.px(9), middle = pen.px(7), inner = pen.px(5);
  const int reach = pen.px(9);
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const double radius = std::hypot(dx, dy);
      if (radius > outer || radius < inner) continue;
      const auto gray = static_cast<std::uint8_t>(radius > middle ? 255 : 0);
      blend(image, x + dx, y + dy, {gray, gray, gray, 255});
    }
  }
}

}  // namespace cmap
