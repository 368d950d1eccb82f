#pragma once

// Point clouds for the tests of indices and metrics, from a fixed generator.

#include <cmath>
#include <random>

#include "cmap/geometry/point_cloud.hpp"

namespace cmap::test {

/// Uniform in [0,1) from the generator's bits alone: the same on every standard library.
inline double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

inline Eigen::Vector3f uniform_point(std::mt19937_64& random, float side) {
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return Eigen::Vector3d(x, y, z).cast<float>() * side;
}

inline PointCloud uniform_cloud(std::size_t n, unsigned seed, float side = 10.0f) {
  std::mt19937_64 random(seed);
  PointCloud cloud;
  for (std::size_t i = 0; i < n; ++i) cloud.positions.push_back(uniform_point(random, side));
  return cloud;
}

/// A wavy sheet, as maps are surfaces; a few points far above it.
inline PointCloud sheet_cloud(std::size_t n, unsigned seed, float side = 20.0f) {
  PointCloud cloud = uniform_cloud(n, seed, side);
  std::mt19937_64 random(seed + 1000);
  for (Eigen::Vector3f& p : cloud.positions) {
    p.z() = std::sin(p.x()) + 0.01f * p.z();
    if (uniform(random) < 0.01) p.z() += 60.0f;
  }
  return cloud;
}

/// Points on a grid of whole numbers: many exact ties.
inline PointCloud grid_cloud(int side) {
  PointCloud cloud;
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      for (int z = 0; z < 3; ++z) {
        cloud.positions.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
      }
    }
  }
  return cloud;
}

inline PointCloud repeated(const PointCloud& cloud, int times) {
  PointCloud result = cloud;
  for (int t = 1; t < times; ++t) {
    result.positions.insert(result.positions.end(), cloud.positions.begin(), cloud.positions.end());
  }
  return result;
}

/// Random 8-bit colors.
inline void paint(PointCloud& cloud, unsigned seed) {
  std::mt19937_64 random(seed);
  Array<Rgb8> colors(cloud.size());
  for (Rgb8& c : colors) {
    const std::uint64_t bits = random();
    c = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8), static_cast<std::uint8_t>(bits >> 16)};
  }
  cloud.colors = std::move(colors);
}

}  // namespace cmap::test
