#include "cmap/render/image.hpp"

#include <algorithm>

namespace cmap {

Image::Image(int width_px, int height_px, Rgba8 background)
    : width(width_px),
      height(height_px),
      pixels(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), background) {}

namespace {

/// `color` laid over `below`; not both transparent.
Rgba8 mixed(Rgba8 below, Rgba8 color) {
  const int over = color[3];
  const int under = (255 - over) * below[3] / 255;  // what of the pixel below still shows
  const int alpha = over + under;
  for (std::size_t c = 0; c < 3; ++c) {
    below[c] = static_cast<std::uint8_t>((color[c] * over + below[c] * under + alpha / 2) / alpha);
  }
  below[3] = static_cast<std::uint8_t>(alpha);
  return below;
}

}  // namespace

Rgba8 over_white(Rgba8 color) { return mixed({255, 255, 255, 255}, color); }

void blend(Image& image, int x, int y, Rgba8 color) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height || color[3] == 0) return;
  image.at(x, y) = mixed(image.at(x, y), color);
}

void fill(Image& image, int x, int y, int width, int height, Rgba8 color) {
  for (int row = y; row < y + height; ++row) {
    for (int column = x; column < x + width; ++column) blend(image, column, row, color);
  }
}

}  // namespace cmap
