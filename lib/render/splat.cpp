#include "cmap/render/splat.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <vector>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

constexpr std::size_t kBlockChunk = 4096;
constexpr std::size_t kRowChunk = 16;

/// A projection in the points' own offsets, in float: what the inner loop needs.
struct OffsetProjection {
  OffsetProjection(const Projection& projection, const Eigen::Vector3d& origin)
      : rotation(projection.axes.cast<float>()),
        translation((projection.axes * (origin - projection.position)).cast<float>()),
        focal(static_cast<float>(projection.focal_px)),
        center_x(0.5f * static_cast<float>(projection.width_px)),
        center_y(0.5f * static_cast<float>(projection.height_px)),
        orthographic(projection.orthographic) {}

  Eigen::Matrix3f rotation;
  Eigen::Vector3f translation;
  float focal, center_x, center_y;
  bool orthographic;
};

struct Splats {
  float x[kBlockSize], y[kBlockSize], depth[kBlockSize], scale[kBlockSize];  ///< pixels, pixels, m, pixels per m
};

void project(const PointBlock& block, const OffsetProjection& p, Splats& s) {
  const auto& r = p.rotation;
  for (std::size_t k = 0; k < kBlockSize; ++k) {
    const float right = r(0, 0) * block.x[k] + r(0, 1) * block.y[k] + r(0, 2) * block.z[k] + p.translation[0];
    const float down = r(1, 0) * block.x[k] + r(1, 1) * block.y[k] + r(1, 2) * block.z[k] + p.translation[1];
    s.depth[k] = r(2, 0) * block.x[k] + r(2, 1) * block.y[k] + r(2, 2) * block.z[k] + p.translation[2];
    s.scale[k] = p.orthographic ? p.focal : p.focal / s.depth[k];
    s.x[k] = p.center_x + right * s.scale[k];
    s.y[k] = p.center_y + down * s.scale[k];
  }
}

void keep_lower(std::uint64_t& cell, std::uint64_t value) {
  const std::atomic_ref<std::uint64_t> shared(cell);
  std::uint64_t current = shared.load(std::memory_order_relaxed);
  while (value < current && !shared.compare_exchange_weak(current, value, std::memory_order_relaxed)) {
  }
}

void draw_square(PixelMap& pixels, float x, float y, float size, std::uint64_t value) {
  const auto first = [size](float center) { return static_cast<int>(std::floor(center - 0.5f * size + 0.5f)); };
  const int side = std::max(1, static_cast<int>(size + 0.5f));
  const int x0 = std::max(0, first(x)), x1 = std::min(pixels.width, first(x) + side);
  const int y0 = std::max(0, first(y)), y1 = std::min(pixels.height, first(y) + side);
  for (int row = y0; row < y1; ++row) {
    const std::size_t begin = static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels.width);
    for (int column = x0; column < x1; ++column) {
      keep_lower(pixels.cells[begin + static_cast<std::size_t>(column)], value);
    }
  }
}

}  // namespace

float PixelMap::depth_m(std::size_t cell) const {
  return std::bit_cast<float>(static_cast<std::uint32_t>(cells[cell] >> 32));
}

double typical_spacing_m(const PointBlocks& points) {
  constexpr std::size_t kSample = 20'000;
  const std::size_t step = std::max<std::size_t>(1, points.blocks.size() / kSample);
  std::vector<double> spacings;
  for (std::size_t b = 0; b < points.blocks.size(); b += step) {
    const PointBlock& p = points.blocks[b];
    const auto extent = [](const float* v) {
      const auto [low, high] = std::minmax_element(v, v + kBlockSize);
      return static_cast<double>(*high) - static_cast<double>(*low);
    };
    double sides[] = {extent(p.x), extent(p.y), extent(p.z)};
    std::ranges::sort(sides);
    // A surface through the block's box covers about its two longest sides.
    spacings.push_back(std::sqrt(std::max(sides[1], 0.25 * sides[2]) * sides[2] / static_cast<double>(kBlockSize)));
  }
  return upper_median(spacings);
}

PixelMap splat(const PointBlocks& points, const Projection& projection, const SplatOptions& options) {
  PixelMap pixels{projection.width_px, projection.height_px, {}};
  pixels.cells.assign(static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height),
                      PixelMap::kEmpty);
  const OffsetProjection offset_projection(projection, points.origin);
  const auto size_m = static_cast<float>(options.point_size_m);
  const auto min_px = static_cast<float>(options.min_size_px);
  const auto max_px = static_cast<float>(options.max_size_px);
  const auto right_edge = static_cast<float>(pixels.width) + max_px;
  const auto bottom_edge = static_cast<float>(pixels.height) + max_px;
  parallel_chunks(points.blocks.size(), kBlockChunk, [&](std::size_t begin, std::size_t end) {
    Splats s;
    for (std::size_t b = begin; b < end; ++b) {
      project(points.blocks[b], offset_projection, s);
      const std::size_t n = std::min(kBlockSize, points.size - b * kBlockSize);
      for (std::size_t k = 0; k < n; ++k) {
        const bool in_sight =
            s.depth[k] > 0.0f && s.x[k] > -max_px && s.x[k] < right_edge && s.y[k] > -max_px && s.y[k] < bottom_edge;
        if (!in_sight) continue;
        const std::uint64_t value =
            static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(s.depth[k])) << 32 | (b * kBlockSize + k);
        draw_square(pixels, s.x[k], s.y[k], std::clamp(size_m * s.scale[k], min_px, max_px), value);
      }
    }
  });
  return pixels;
}

Array<float> eye_dome_shading(const PixelMap& pixels, const Projection& projection, double strength) {
  constexpr int kRadius = 2;
  constexpr int kHalfCircle[4][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}};
  constexpr double kFull_px = 6.0;  // this far behind the middle of two opposite neighbors is all in their shade
  Array<float> shading(pixels.cells.size());
  const auto width = static_cast<std::size_t>(pixels.width);
  parallel_chunks(static_cast<std::size_t>(pixels.height), kRowChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin * width; cell < end * width; ++cell) {
      shading[cell] = 1.0f;
      if (pixels.is_empty(cell)) continue;
      const double depth = static_cast<double>(pixels.depth_m(cell));
      const int x = static_cast<int>(cell % width), y = static_cast<int>(cell / width);
      double shade = 0.0;
      for (const auto& [dx, dy] : kHalfCircle) {
        const int reach_x = kRadius * dx, reach_y = kRadius * dy;
        if (std::min(x + reach_x, x - reach_x) < 0 || std::max(x + reach_x, x - reach_x) >= pixels.width) continue;
        if (y - reach_y < 0 || y + reach_y >= pixels.height) continue;
        const std::ptrdiff_t step = reach_y * static_cast<std::ptrdiff_t>(width) + reach_x;
        const std::size_t ahead = cell + static_cast<std::size_t>(step), behind = cell - static_cast<std::size_t>(step);
        if (pixels.is_empty(ahead) || pixels.is_empty(behind)) continue;
        const double middle =
            0.5 * (static_cast<double>(pixels.depth_m(ahead)) + static_cast<double>(pixels.depth_m(behind)));
        shade += std::clamp((depth - middle) / (kFull_px * projection.meters_per_pixel(depth)), 0.0, 1.0);
      }
      shading[cell] = static_cast<float>(std::exp(-strength * shade));
    }
  });
  return shading;
}

}  // namespace cmap
