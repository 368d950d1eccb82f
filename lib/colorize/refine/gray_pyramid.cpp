#include "refine/gray_pyramid.hpp"

#include <algorithm>
#include <cmath>

namespace cmap {

GrayPyramid::GrayPyramid(const RgbImage& image, int levels) {
  Level finest{image.width, image.height, Array<float>(image.pixels.size())};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Rgb8& c = image.pixels[i];
    finest.gray[i] = 0.25f * static_cast<float>(c[0] + 2 * c[1] + c[2]);
  }
  levels_.push_back(smoothed(finest));
  while (this->levels() < levels && std::min(levels_.back().width, levels_.back().height) >= 32) {
    levels_.push_back(smoothed(halved(levels_.back())));
  }
}

/// By 1 2 1 both ways; the border stays.
GrayPyramid::Level GrayPyramid::smoothed(const Level& level) {
  Level made = level;
  for (int y = 1; y + 1 < level.height; ++y) {
    for (int x = 1; x + 1 < level.width; ++x) {
      const auto row = [&](int v) { return level.at(x - 1, v) + 2.0f * level.at(x, v) + level.at(x + 1, v); };
      made.gray[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) + static_cast<std::size_t>(x)] =
          (row(y - 1) + 2.0f * row(y) + row(y + 1)) / 16.0f;
    }
  }
  return made;
}

GrayPyramid::Level GrayPyramid::halved(const Level& level) {
  Level made{level.width / 2, level.height / 2, {}};
  for (int y = 0; y < made.height; ++y) {
    for (int x = 0; x < made.width; ++x) {
      const float sum = level.at(2 * x, 2 * y) + level.at(2 * x + 1, 2 * y) + level.at(2 * x, 2 * y + 1) +
                        level.at(2 * x + 1, 2 * y + 1);
      made.gray.push_back(0.25f * sum);
    }
  }
  return made;
}

std::optional<GraySample> GrayPyramid::at(int level, const Eigen::Vector2d& pixel) const {
  const Level& image = levels_[static_cast<std::size_t>(level)];
  const auto scale = static_cast<float>(1 << level);
  const Eigen::Vector2f p = (pixel.cast<float>().array() + 0.5f) / scale - 0.5f;
  if (!(p.x() >= 1.0f && p.y() >= 1.0f && p.x() < static_cast<float>(image.width - 2) &&
        p.y() < static_cast<float>(image.height - 2))) {
    return std::nullopt;
  }
  const auto x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
  const float a = p.x() - static_cast<float>(x), b = p.y() - static_cast<float>(y);
  const float n00 = image.at(x, y), n10 = image.at(x + 1, y), n01 = image.at(x, y + 1), n11 = image.at(x + 1, y + 1);
  GraySample sample;
  sample.level = (1.0f - b) * ((1.0f - a) * n00 + a * n10) + b * ((1.0f - a) * n01 + a * n11);
  sample.gradient =
      Eigen::Vector2f((1.0f - b) * (n10 - n00) + b * (n11 - n01), (1.0f - a) * (n01 - n00) + a * (n11 - n10)) / scale;
  return sample;
}

}  // namespace cmap
