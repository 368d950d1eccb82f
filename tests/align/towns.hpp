#pragma once

// A town for the tests of registrations.

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "cmap/io/point_cloud_file.hpp"
#include "spatial/clouds.hpp"

namespace cmap::test {

/// A map of the sample town.
inline PointCloud sample_town(const char* name) {
  const std::filesystem::path source = std::getenv("CMAP_SOURCE_DIR");  // set by CTest
  return read_point_cloud(source / "data_samples/town" / name).cloud;
}

/// A town as in notes 9.3: wavy ground of the given half width with houses of several sizes; the same world for every
/// seed of the samples.
inline PointCloud town(double half_width_m, std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  PointCloud cloud;
  while (cloud.size() < n) {
    const double x = half_width_m * (2.0 * uniform(random) - 1.0);
    const double y = half_width_m * (2.0 * uniform(random) - 1.0);
    const double u = uniform(random), v = uniform(random);
    const double block_x = std::floor(x / 30.0), block_y = std::floor(y / 30.0);
    const double kind = std::sin(12.9898 * block_x + 78.233 * block_y) * 43758.5453;
    const double dice = kind - std::floor(kind);
    const double lx = x - 30.0 * block_x - 6.0, ly = y - 30.0 * block_y - 6.0;
    const double side_x = 10.0 + 8.0 * dice, side_y = 18.0 - 8.0 * dice, height = 6.0 + 12.0 * dice;
    double z = std::sin(0.05 * x) + std::cos(0.07 * y);
    Eigen::Vector3d p(x, y, z);
    if (dice > 0.3 && lx > 0 && ly > 0 && lx < side_x && ly < side_y) {
      p.z() = height;
      if (u < 0.5) {  // onto a wall
        if (v < 0.5) {
          p.x() = 30.0 * block_x + 6.0 + (lx < side_x / 2 ? 0.0 : side_x);
        } else {
          p.y() = 30.0 * block_y + 6.0 + (ly < side_y / 2 ? 0.0 : side_y);
        }
        p.z() = height * uniform(random);
      }
    }
    if (std::abs(p.x()) > half_width_m || std::abs(p.y()) > half_width_m) continue;
    cloud.positions.push_back(p.cast<float>());
  }
  return cloud;
}

}  // namespace cmap::test
