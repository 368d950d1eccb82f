#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/geometry/rgb_image.hpp"

namespace cmap {

/// A gray level between pixels, 0 to 255, and how it changes by a pixel of the image's.
struct GraySample {
  float level = 0.0f;
  Eigen::Vector2f gradient = Eigen::Vector2f::Zero();
};

/// An image in gray, and it smoothed and halved again and again; four bytes a pixel.
class GrayPyramid {
 public:
  GrayPyramid() = default;
  /// Gray is (r + 2 g + b) / 4.
  GrayPyramid(const RgbImage& image, int levels);

  int levels() const { return static_cast<int>(levels_.size()); }
  /// Bilinear; level 0 is the image itself, and pixels are those of the image. None nearer than a pixel to the border.
  std::optional<GraySample> at(int level, const Eigen::Vector2d& pixel) const;

 private:
  struct Level {
    int width = 0, height = 0;
    Array<float> gray;

    float at(int x, int y) const {
      return gray[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
  };
  static Level smoothed(const Level& level);
  static Level halved(const Level& level);

  std::vector<Level> levels_;
};

}  // namespace cmap
