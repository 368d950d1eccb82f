#pragma once

#include <vector>

#include "io/io_testing.hpp"

namespace cmap::testing {

inline PointCloud random_cloud(std::size_t n, float extent_m) {
  PointCloud cloud;
  std::uint32_t state = 7;
  for (std::size_t i = 0; i < n; ++i) {
    Eigen::Vector3f p;
    for (int k = 0; k < 3; ++k) {
      state = state * 1664525U + 1013904223U;
      p[k] = (static_cast<float>(state >> 8) / 16777216.0F - 0.5F) * extent_m;
    }
    cloud.positions.push_back(p);
  }
  return cloud;
}

template <class Color, class Channel>
Array<Color> random_colors(std::size_t n, Channel channel) {
  Array<Color> colors(n);
  std::uint32_t state = 99;
  for (Color& color : colors) {
    for (auto& value : color) value = channel((state = state * 1664525U + 1013904223U) >> 8);
  }
  return colors;
}

/// Clouds of every kind of color, near zero and far from it, of one point and of more than a block.
inline std::vector<PointCloud> sample_clouds() {
  std::vector<PointCloud> clouds;
  for (const std::size_t n : {std::size_t{1}, std::size_t{40000}}) {
    for (const bool far : {false, true}) {
      // Far away the offsets are multiples of 2^-10 m, as a double near 4e6 keeps them; the bounds fix the origin.
      PointCloud cloud = random_cloud(n, n == 1 ? 0.8F : 80.0F);
      if (far) {
        for (Eigen::Vector3f& p : cloud.positions) p = (p * 1024.0F).array().round() / 1024.0F;
        cloud.positions[0] = {40.0F, 40.0F, 40.0F};
        if (n > 1) cloud.positions[1] = {-40.0F, -40.0F, -40.0F};
        Box3d box = bounds(cloud);
        const Eigen::Vector3d shift(500000, 4000000, 1000);
        cloud.origin = choose_origin({box.min + shift, box.max + shift});
        if (n == 1) cloud.positions[0] = (shift + Eigen::Vector3d::Constant(40) - cloud.origin).cast<float>();
      }
      clouds.push_back(cloud);
      cloud.colors = random_colors<Rgb8>(n, [](std::uint32_t v) { return static_cast<U8>(v); });
      clouds.push_back(cloud);
      cloud.colors = random_colors<Rgb16>(n, [](std::uint32_t v) { return static_cast<U16>(v); });
      clouds.push_back(cloud);
      cloud.colors = random_colors<RgbF>(n, [](std::uint32_t v) { return static_cast<float>(v) / 16777216.0F; });
      clouds.push_back(cloud);
    }
  }
  return clouds;
}

}  // namespace cmap::testing
