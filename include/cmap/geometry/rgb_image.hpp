#pragma once

#include <cstddef>

#include "cmap/core/array.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// A photograph, row by row from the top. (What programs draw is render's Image, which has an alpha channel.)
struct RgbImage {
  int width = 0, height = 0;
  Array<Rgb8> pixels;

  Rgb8& at(int x, int y) { return pixels[index(x, y)]; }
  const Rgb8& at(int x, int y) const { return pixels[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

}  // namespace cmap
