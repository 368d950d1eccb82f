#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include "cmap/core/array.hpp"
#include "cmap/io/output_file.hpp"

namespace cmap {

using Rgba8 = std::array<std::uint8_t, 4>;

/// A picture, row by row from the top; alpha is not premultiplied.
struct Image {
  Image(int width_px, int height_px, Rgba8 background);

  int width, height;
  Array<Rgba8> pixels;

  Rgba8& at(int x, int y) { return pixels[index(x, y)]; }
  const Rgba8& at(int x, int y) const { return pixels[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// An opaque color: what a transparent one looks like on white.
Rgba8 over_white(Rgba8 color);

/// Lays `color` over the pixel; outside of the image nothing happens.
void blend(Image& image, int x, int y, Rgba8 color);
void fill(Image& image, int x, int y, int width, int height, Rgba8 color);

enum class TextAnchor { kLeft, kCenter, kRight };

/// A line of text whose capitals are about 0.73 size_px high. (x, y) is the anchor on the line's vertical middle.
void draw_text(Image& image, int x, int y, std::string_view utf8, int size_px, Rgba8 color,
               TextAnchor anchor = TextAnchor::kLeft);

/// Width of what draw_text would draw.
int text_width(std::string_view utf8, int size_px);

/// Throws UsageError unless the name ends in .png, .jpg, .jpeg, .tif or .tiff.
void check_image_name(const std::filesystem::path& name);

/// The format is that of the name: PNG and TIFF with alpha, JPEG over white.
void write_image(const Image& image, const std::filesystem::path& name, OutputFile& file);

}  // namespace cmap
