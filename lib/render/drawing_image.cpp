#include "cmap/render/drawing_image.hpp"

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace cmap {
namespace {

Rgba8 opaque(const Drawing::Color& color) { return {color[0], color[1], color[2], 255}; }

int pixels(double length, double scale) { return static_cast<int>(std::lround(length * scale)); }

void draw(Image& image, const Drawing::Line& line, double scale) {
  constexpr int kFractionBits = 8;
  std::vector<cv::Point> points;
  for (const auto& [x, y] : line.points) {
    points.emplace_back(pixels(x, scale * (1 << kFractionBits)), pixels(y, scale * (1 << kFractionBits)));
  }
  cv::Mat view(image.height, image.width, CV_8UC4, image.pixels.data());
  const cv::Scalar color(line.color[0], line.color[1], line.color[2], 255);
  cv::polylines(view, points, false, color, std::max(1, pixels(line.width, scale)), cv::LINE_AA, kFractionBits);
}

void draw(Image& image, const Drawing::Box& box, double scale) {
  const int x = pixels(box.x, scale), y = pixels(box.y, scale);
  fill(image, x, y, pixels(box.x + box.width, scale) - x, pixels(box.y + box.height, scale) - y, opaque(box.color));
}

void draw(Image& image, const Drawing::Text& text, double scale) {
  const TextAnchor anchor = text.anchor == Drawing::Anchor::kLeft     ? TextAnchor::kLeft
                            : text.anchor == Drawing::Anchor::kCenter ? TextAnchor::kCenter
                                                                      : TextAnchor::kRight;
  draw_text(image, pixels(text.x, scale), pixels(text.y, scale), text.text, pixels(text.size, scale),
            opaque(text.color), anchor);
}

}  // namespace

Image image_of(const Drawing& drawing, double scale) {
  Image image(pixels(drawing.width, scale), pixels(drawing.height, scale), {255, 255, 255, 255});
  for (const auto& shape : drawing.shapes) {
    std::visit([&](const auto& s) { draw(image, s, scale); }, shape);
  }
  return image;
}

}  // namespace cmap
