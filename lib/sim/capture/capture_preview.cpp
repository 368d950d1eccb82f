#include "capture/capture_preview.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/color.hpp"
#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

constexpr int kWidth_px = 640, kHeight_px = 480;

/// A window in the plane, with square pixels.
struct PlaneWindow {
  Eigen::Vector2d center;
  double m_per_px;

  PlaneWindow(const Eigen::Vector2d& min, const Eigen::Vector2d& max)
      : center(0.5 * (min + max)),
        m_per_px(std::max((max.x() - min.x()) / kWidth_px, (max.y() - min.y()) / kHeight_px)) {}
  Eigen::Vector2d place(int u, int v) const {
    return center + m_per_px * Eigen::Vector2d(u + 0.5 - 0.5 * kWidth_px, 0.5 * kHeight_px - v - 0.5);
  }
  Eigen::Vector2i pixel(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d q = (p - center) / m_per_px;
    return {static_cast<int>(std::floor(q.x() + 0.5 * kWidth_px)),
            static_cast<int>(std::floor(0.5 * kHeight_px - q.y()))};
  }
};

/// One panel of the picture.
class Panel {
 public:
  Panel(RgbImage& image, int column, int row) : image_(image), u0_(column * kWidth_px), v0_(row * kHeight_px) {}

  void set(int u, int v, const Rgb8& color) {
    if (u < 0 || v < 0 || u >= kWidth_px || v >= kHeight_px) return;
    image_.pixels[static_cast<std::size_t>(v0_ + v) * static_cast<std::size_t>(image_.width) +
                  static_cast<std::size_t>(u0_ + u)] = color;
  }
  void fill(const std::function<Rgb8(int u, int v)>& color) {
    parallel_chunks(kHeight_px, 8, [&](std::size_t begin, std::size_t end) {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
        for (int u = 0; u < kWidth_px; ++u) set(u, v, color(u, v));
      }
    });
  }

 private:
  RgbImage& image_;
  int u0_, v0_;
};

Rgb8 gray(double share) {
  const auto level = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
  return {level, level, level};
}

void draw_map(Panel panel, const Scene& scene, const PoseSpline& path, double from_z_m) {
  constexpr double kStep_s = 0.2, kMargin_m = 15.0;
  std::vector<Eigen::Vector2d> way;
  for (double t = path.start_s(); t <= path.end_s(); t += kStep_s) {
    way.emplace_back(path.pose(t).translation().head<2>());
  }
  Eigen::Vector2d min = way.front(), max = way.front();
  for (const Eigen::Vector2d& p : way) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  const PlaneWindow window(min.array() - kMargin_m, max.array() + kMargin_m);
  panel.fill([&](int u, int v) -> Rgb8 {
    const Eigen::Vector2d p = window.place(u, v);
    const auto hit = scene.cast({p.x(), p.y(), from_z_m}, -Eigen::Vector3d::UnitZ(), 1e4);
    if (!hit) return {255, 255, 255};
    return to_rgb8(255.0F * Eigen::Vector3f(hit->color[0], hit->color[1], hit->color[2]));
  });
  for (const Eigen::Vector2d& p : way) {
    const Eigen::Vector2i c = window.pixel(p);
    for (int i = 0; i < 9; ++i) panel.set(c.x() + i % 3 - 1, c.y() + i / 3 - 1, {255, 0, 0});
  }
}

/// The whole view, shrunk or enlarged to fit; `color` by its pixel.
void draw_view(Panel panel, int width, int height, const std::function<Rgb8(std::size_t pixel)>& color) {
  const double scale = std::max(static_cast<double>(width) / kWidth_px, static_cast<double>(height) / kHeight_px);
  panel.fill([&](int u, int v) -> Rgb8 {
    const auto x = static_cast<std::size_t>(u * scale), y = static_cast<std::size_t>(v * scale);
    if (x >= static_cast<std::size_t>(width) || y >= static_cast<std::size_t>(height)) return {255, 255, 255};
    return color(y * static_cast<std::size_t>(width) + x);
  });
}

/// Drawn at half brightness.
double median_depth_m(const Array<float>& depth_m) {
  std::vector<float> finite;
  for (const float d : depth_m) {
    if (std::isfinite(d)) finite.push_back(d);
  }
  return finite.empty() ? 1.0 : upper_median(finite);
}

void draw_scan(Panel panel, std::span<const Eigen::Vector3f> scan) {
  panel.fill([](int, int) { return Rgb8{0, 0, 60}; });
  if (scan.empty()) return;
  std::vector<float> reach, heights;  // in the plane, upward
  for (const Eigen::Vector3f& p : scan) {
    reach.push_back(p.head<2>().norm());
    heights.push_back(p.z());
  }
  std::ranges::sort(reach);
  std::ranges::sort(heights);
  const double r = reach[reach.size() * 95 / 100];
  const double low = heights[heights.size() / 50], high = heights[heights.size() * 49 / 50];
  const PlaneWindow window({-r, -r}, {r, r});
  for (const Eigen::Vector3f& p : scan) {
    const Eigen::Vector2i c = window.pixel(p.head<2>().cast<double>());
    panel.set(c.x(), c.y(), gray(0.3 + 0.7 * (p.z() - low) / std::max(0.1, high - low)));
  }
}

}  // namespace

RgbImage capture_preview(const Scene& scene, const PoseSpline& path, double from_z_m, const CameraView& view,
                         std::span<const Eigen::Vector3f> scan) {
  RgbImage image;
  image.width = 2 * kWidth_px;
  image.height = 2 * kHeight_px;
  image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  draw_map(Panel(image, 0, 0), scene, path, from_z_m);
  draw_view(Panel(image, 1, 0), view.image.width, view.image.height,
            [&](std::size_t i) { return view.image.pixels[i]; });
  const double middle_m = median_depth_m(view.depth_m);
  draw_view(Panel(image, 0, 1), view.image.width, view.image.height,
            [&](std::size_t i) { return gray(middle_m / (middle_m + static_cast<double>(view.depth_m[i]))); });
  draw_scan(Panel(image, 1, 1), scan);
  return image;
}

}  // namespace cmap
