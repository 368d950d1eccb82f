// What an image says of a point, and how much that counts.

#include <algorithm>
#include <cmath>

#include "cmap/colorize/colorize.hpp"

namespace cmap {

double view_weight(const ViewPoint& point, const CameraModel& camera, const ViewWeightOptions& options) {
  const double range = point.range_m;
  const double cosine = point.normal.isZero() ? 1.0 : std::abs(point.normal.dot(point.position)) / range;
  const double of_angle = std::pow(std::max(cosine, options.least_cosine), options.angle_power);
  const double in_near_ranges = range / options.near_range_m;
  const double of_range = std::pow(1.0 + in_near_ranges * in_near_ranges, -0.5 * options.range_power);
  const double x = point.pixel.x(), y = point.pixel.y();
  const double to_border = std::min({x + 0.5, y + 0.5, camera.width - 0.5 - x, camera.height - 0.5 - y});
  const double ramp = options.border_share * std::min(camera.width, camera.height);
  const double inside = ramp > 0.0 ? std::clamp(to_border / ramp, 0.0, 1.0) : 1.0;
  return of_angle * of_range * (options.least_border_weight + (1.0 - options.least_border_weight) * inside);
}

Rgb8 color_at(const RgbImage& image, const Eigen::Vector2f& pixel) {
  const float x = std::clamp(pixel.x(), 0.0f, static_cast<float>(image.width - 1));
  const float y = std::clamp(pixel.y(), 0.0f, static_cast<float>(image.height - 1));
  const auto left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = std::min(left + 1, image.width - 1), bottom = std::min(top + 1, image.height - 1);
  const float a = x - static_cast<float>(left), b = y - static_cast<float>(top);
  Rgb8 color;
  for (std::size_t c = 0; c < 3; ++c) {
    const float above = (1.0f - a) * image.at(left, top)[c] + a * image.at(right, top)[c];
    const float below = (1.0f - a) * image.at(left, bottom)[c] + a * image.at(right, bottom)[c];
    color[c] = static_cast<std::uint8_t>(std::lround((1.0f - b) * above + b * below));
  }
  return color;
}

}  // namespace cmap
