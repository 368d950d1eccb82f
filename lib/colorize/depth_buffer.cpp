#include "cmap/colorize/depth_buffer.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

constexpr std::size_t kSplatChunk = 1024;
constexpr float kEdgeOn = 0.02f;       ///< cosine below which a disc is a line
constexpr float kNormalError = 0.05f;  ///< of a disc, rad
constexpr float kFlattest = 0.017f;    ///< angle between ray and disc, rad

/// The camera of an image of fewer, larger pixels.
CameraModel reduced(CameraModel camera, int reduction) {
  const double r = reduction;
  camera.width = (camera.width + reduction - 1) / reduction;
  camera.height = (camera.height + reduction - 1) / reduction;
  camera.fx /= r;
  camera.fy /= r;
  camera.cx = (camera.cx + 0.5) / r - 0.5;
  camera.cy = (camera.cy + 0.5) / r - 0.5;
  return camera;
}

int reduction_for(const CameraModel& camera, int most_pixels) {
  const double pixels = static_cast<double>(camera.width) * camera.height;
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / most_pixels))));
}

/// Where a ray meets the disc's plane; NaN where it runs along it, or there is no ray.
float range_of_plane(const ViewPoint& point, const Eigen::Vector3f& ray) {
  const float cosine = point.normal.dot(ray);
  if (!(std::abs(cosine) > kEdgeOn)) return std::numeric_limits<float>::quiet_NaN();
  return point.normal.dot(point.position) / cosine;
}

/// Half the width in pixels of a disc's image, at most.
float splat_px(const CameraModel& camera, const ViewPoint& point) {
  const auto f = static_cast<float>(std::max(camera.fx, camera.fy));
  const float z = point.position.z(), range = point.range_m;
  if (camera.projection == CameraProjection::kPinhole) return 1.1f * f * point.radius_m * range / (z * z);
  const float angle = std::atan2(point.position.head<2>().norm(), z);
  return 1.1f * f * point.radius_m / range * std::max(1.0f, angle / std::max(0.1f, std::sin(angle)));
}

}  // namespace

DepthBuffer::DepthBuffer(const CameraModel& camera, const OcclusionOptions& options)
    : options_(options),
      reduction_(reduction_for(camera, options.most_pixels)),
      camera_(reduced(camera, reduction_)),
      rays_(static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height)),
      ranges_(rays_.size()) {
  parallel_chunks(static_cast<std::size_t>(camera_.height), 8, [&](std::size_t begin, std::size_t end) {
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < camera_.width; ++x) rays_[index(x, y)] = ray_of(camera_, {x, y}).cast<float>();
    }
  });
}

Eigen::Vector2f DepthBuffer::buffer_pixel(const Eigen::Vector2f& image_pixel) const {
  return (image_pixel.array() + 0.5f) / static_cast<float>(reduction_) - 0.5f;
}

/// Ranges are positive, so that their bits are ordered as they are.
void DepthBuffer::lower(std::size_t pixel, float range_m) {
  const std::atomic_ref<float> place(ranges_[pixel]);
  float before = place.load(std::memory_order_relaxed);
  while (range_m < before && !place.compare_exchange_weak(before, range_m, std::memory_order_relaxed)) {
  }
}

void DepthBuffer::draw(const ViewPoint& point) {
  const Eigen::Vector2f center = buffer_pixel(point.pixel);
  const float half = std::min(splat_px(camera_, point), static_cast<float>(options_.largest_splat_px));
  const int left = std::max(0, static_cast<int>(std::ceil(center.x() - half)));
  const int right = std::min(camera_.width - 1, static_cast<int>(std::floor(center.x() + half)));
  const int top = std::max(0, static_cast<int>(std::ceil(center.y() - half)));
  const int bottom = std::min(camera_.height - 1, static_cast<int>(std::floor(center.y() + half)));
  const float sq_radius = point.radius_m * point.radius_m;
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const Eigen::Vector3f& ray = rays_[index(x, y)];
      const float range = range_of_plane(point, ray);
      if (range > 0.0f && (range * ray - point.position).squaredNorm() <= sq_radius) lower(index(x, y), range);
    }
  }
  const auto x = static_cast<int>(std::lround(center.x())), y = static_cast<int>(std::lround(center.y()));
  if (x < 0 || y < 0 || x >= camera_.width || y >= camera_.height) return;
  const float range = range_of_plane(point, rays_[index(x, y)]);
  const float nearest = std::max(0.5f * point.range_m, point.range_m - point.radius_m);
  lower(index(x, y), std::isfinite(range) ? std::clamp(range, nearest, point.range_m + point.radius_m) : point.range_m);
}

void DepthBuffer::fill(std::span<const ViewPoint> points) {
  std::fill(ranges_.begin(), ranges_.end(), std::numeric_limits<float>::infinity());
  parallel_chunks(points.size(), kSplatChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) draw(points[i]);
  });
}

/// How much nearer a surface must be to hide the point on its own ray.
float DepthBuffer::tolerance_of(const ViewPoint& point, float cosine) const {
  const auto least = static_cast<float>(options_.tolerance_m + options_.relative_tolerance * point.range_m);
  if (point.normal.isZero()) return least;
  const auto thickness = static_cast<float>(options_.thickness_m);
  return std::max(least, std::min(static_cast<float>(options_.largest_tolerance_m), thickness / cosine));
}

bool DepthBuffer::hides(const ViewPoint& point) const {
  const Eigen::Vector2f center = buffer_pixel(point.pixel);
  const auto on_buffer = [](float at, int size) { return std::clamp(static_cast<int>(std::lround(at)), 0, size - 1); };
  const int own_x = on_buffer(center.x(), camera_.width), own_y = on_buffer(center.y(), camera_.height);
  const float cosine = std::abs(point.normal.dot(point.position)) / point.range_m;
  const float tolerance = tolerance_of(point, cosine);
  const float plane = range_of_plane(point, rays_[index(own_x, own_y)]);
  const float own = std::isfinite(plane) ? std::clamp(plane, 0.7f * point.range_m, point.range_m) : point.range_m;
  if (ranges_[index(own_x, own_y)] < own - tolerance) return true;

  // Around it the point's surface may come nearer, the more the flatter it is seen.
  const float flat = point.normal.isZero() ? 0.5f * std::numbers::pi_v<float> : std::asin(std::min(1.0f, cosine));
  const float slope = point.range_m / std::tan(std::max(flat - kNormalError, kFlattest));
  const Eigen::Vector3f direction = point.position / point.range_m;
  const float reach = static_cast<float>(options_.edge_px) / static_cast<float>(reduction_);
  const int right = on_buffer(center.x() + reach, camera_.width),
            bottom = on_buffer(center.y() + reach, camera_.height);
  for (int y = on_buffer(center.y() - reach, camera_.height); y <= bottom; ++y) {
    for (int x = on_buffer(center.x() - reach, camera_.width); x <= right; ++x) {
      const float away = slope * (rays_[index(x, y)] - direction).norm();
      if (ranges_[index(x, y)] < point.range_m - tolerance - away) return true;
    }
  }
  return false;
}

}  // namespace cmap
