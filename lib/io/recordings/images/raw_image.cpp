#include <fmt/format.h>

#include <array>
#include <optional>

#include "cmap/core/error.hpp"
#include "cmap/io/unpack_recording.hpp"

namespace cmap {
namespace {

/// Where in a pixel its red, green and blue are.
struct PixelLayout {
  std::size_t bytes;
  std::array<std::size_t, 3> place;
};

std::optional<PixelLayout> layout_of(const RecordedImage& image) {
  const std::string& name = image.encoding;
  if (name == "rgb8") return PixelLayout{3, {0, 1, 2}};
  if (name == "bgr8" || name == "8UC3") return PixelLayout{3, {2, 1, 0}};
  if (name == "rgba8") return PixelLayout{4, {0, 1, 2}};
  if (name == "bgra8" || name == "8UC4") return PixelLayout{4, {2, 1, 0}};
  if (name == "mono8" || name == "8UC1") return PixelLayout{1, {0, 0, 0}};
  if (name == "mono16" || name == "16UC1") {
    const std::size_t high = image.is_big_endian ? 0 : 1;
    return PixelLayout{2, {high, high, high}};
  }
  return std::nullopt;
}

/// The color (0 red, 1 green, 2 blue) of each of a Bayer pattern's four pixels; none: another encoding.
std::optional<std::array<int, 4>> bayer_of(const std::string& name) {
  if (name == "bayer_rggb8") return std::array{0, 1, 1, 2};
  if (name == "bayer_bggr8") return std::array{2, 1, 1, 0};
  if (name == "bayer_gbrg8") return std::array{1, 2, 0, 1};
  if (name == "bayer_grbg8") return std::array{1, 0, 2, 1};
  return std::nullopt;
}

std::uint8_t byte_at(const RecordedImage& image, int x, int y) {
  return std::to_integer<std::uint8_t>(
      image.bytes[static_cast<std::size_t>(y) * image.row_bytes + static_cast<std::size_t>(x)]);
}

/// Of each color the mean over the pixel and those around it that have it, itself first.
Rgb8 interpolated(const RecordedImage& image, const std::array<int, 4>& colors, int x, int y) {
  std::array<int, 3> sum{}, n{};
  const auto color_at = [&](int u, int v) {
    return static_cast<std::size_t>(colors[static_cast<std::size_t>(2 * (v & 1) + (u & 1))]);
  };
  for (int v = std::max(0, y - 1); v <= std::min(image.height - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(image.width - 1, x + 1); ++u) {
      const std::size_t color = color_at(u, v);
      const bool is_itself = u == x && v == y;
      if (!is_itself && color == color_at(x, y)) continue;
      sum[color] += byte_at(image, u, v);
      ++n[color];
    }
  }
  Rgb8 pixel{};
  for (std::size_t k = 0; k < 3; ++k) {
    pixel[k] = static_cast<std::uint8_t>(n[k] == 0 ? 0 : (2 * sum[k] + n[k]) / (2 * n[k]));
  }
  return pixel;
}

void require_rows(const RecordedImage& image, std::size_t pixel_bytes) {
  if (image.row_bytes >= static_cast<std::size_t>(image.width) * pixel_bytes) return;
  throw InputError(
      fmt::format("rows of {} bytes do not hold {} pixels of {}", image.row_bytes, image.width, image.encoding));
}

}  // namespace

RgbImage rgb_of_raw(const RecordedImage& image) {
  RgbImage rgb;
  rgb.width = image.width;
  rgb.height = image.height;
  rgb.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const std::optional<PixelLayout> layout = layout_of(image);
  const std::optional<std::array<int, 4>> bayer = bayer_of(image.encoding);
  if (!layout && !bayer) {
    throw UnsupportedError(fmt::format("images of encoding \"{}\" are not read", image.encoding));
  }
  require_rows(image, layout ? layout->bytes : 1);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (bayer) {
        rgb.at(x, y) = interpolated(image, *bayer, x, y);
        continue;
      }
      const int first = x * static_cast<int>(layout->bytes);
      for (std::size_t k = 0; k < 3; ++k)
        rgb.at(x, y)[k] = byte_at(image, first + static_cast<int>(layout->place[k]), y);
    }
  }
  return rgb;
}

}  // namespace cmap
