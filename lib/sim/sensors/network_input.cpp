#include "cmap/sim/network_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/color.hpp"

namespace cmap {
namespace {

/// Between pixel centers; at most half a pixel outside of them.
Eigen::Vector3f interpolated(const RgbImage& image, const Eigen::Vector2d& pixel) {
  const double x = std::clamp(pixel.x(), 0.0, image.width - 1.0), y = std::clamp(pixel.y(), 0.0, image.height - 1.0);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const float tx = static_cast<float>(x - x0), ty = static_cast<float>(y - y0);
  const auto at = [&](int u, int v) {
    const Rgb8& c = image.at(u, v);
    return Eigen::Vector3f(c[0], c[1], c[2]);
  };
  return (1.0F - ty) * ((1.0F - tx) * at(x0, y0) + tx * at(x1, y0)) + ty * ((1.0F - tx) * at(x0, y1) + tx * at(x1, y1));
}

/// What the picture shows at a pixel of the network's; none outside.
std::optional<Eigen::Vector3f> seen_at(const RgbImage& image, const CameraModel& camera, const CameraModel& network,
                                       double u, double v) {
  const Eigen::Vector3d ray((u - network.cx) / network.fx, (v - network.cy) / network.fy, 1.0);
  const auto pixel = project(camera, ray);
  if (!pixel) return std::nullopt;
  // Where the network's pixels end with the picture's, rounding must not decide.
  const Eigen::Vector2d center(0.5 * (camera.width - 1), 0.5 * (camera.height - 1));
  if (!is_inside(camera, *pixel + 1e-9 * (center - *pixel))) return std::nullopt;
  return interpolated(image, *pixel);
}

}  // namespace

CameraModel network_camera(const CameraModel& camera, int width_px) {
  constexpr int kPatch = 14;
  if (width_px <= 0 || width_px % kPatch != 0) {
    throw UsageError(fmt::format("width_px {} is not a positive multiple of {}", width_px, kPatch));
  }
  // nearbyint rounds half to even, as Python's round does.
  const double patches = static_cast<double>(camera.height) * width_px / camera.width / kPatch;
  const int height = kPatch * std::max(1, static_cast<int>(std::nearbyint(patches)));
  CameraModel network;
  network.width = width_px;
  network.height = std::min(height, width_px);
  network.fx = camera.fx * width_px / camera.width;
  network.fy = camera.fy * height / camera.height;
  network.cx = 0.5 * network.width;
  network.cy = 0.5 * network.height;
  return network;
}

NetworkImage network_image(const RgbImage& image, const CameraModel& camera, const CameraModel& network) {
  if (image.width != camera.width || image.height != camera.height) {
    throw UsageError(fmt::format("a picture of {} x {} pixels from a camera of {} x {}", image.width, image.height,
                                 camera.width, camera.height));
  }
  // Samples as dense as the picture's pixels are near its center.
  const int s = static_cast<int>(std::ceil(std::max(camera.fx / network.fx, camera.fy / network.fy) - 1e-9));
  const auto width = static_cast<std::size_t>(network.width), height = static_cast<std::size_t>(network.height);
  NetworkImage result{{network.width, network.height, Array<Rgb8>(width * height)},
                      Array<std::uint8_t>(width * height)};
  parallel_chunks(height, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * width; i < end * width; ++i) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      int n = 0;
      for (int k = 0; k < s * s; ++k) {
        const double u = static_cast<double>(i % width) + (k % s + 0.5) / s - 0.5;
        const double v = static_cast<double>(i / width) + (k / s + 0.5) / s - 0.5;
        const auto color = seen_at(image, camera, network, u, v);
        if (!color) continue;
        sum += *color;
        ++n;
      }
      result.image.pixels[i] = n > 0 ? to_rgb8(sum / static_cast<float>(n)) : Rgb8{0, 0, 0};
      result.is_shown[i] = n > 0 ? 1 : 0;
    }
  });
  return result;
}

}  // namespace cmap
