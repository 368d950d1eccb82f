#pragma once

#include <Eigen/Core>
#include <vector>

#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// What stands about a place, seen from above: cells of a square about the origin, whose value says how tall that is.
/// A cell counts the slices of height, as high as it is wide, that hold a point, from half a slice above local ground,
/// 10 at most, over 10: a wall is bright, a ceiling or a crown is not, and the sensor's height does not matter.
struct BirdsEye {
  struct Cell {
    Eigen::Vector2f center;  ///< m, level frame
    float value;
  };
  int side = 0;  ///< cells; the square reaches side / 2 cells from the origin
  double cell_m = 0.0;
  std::vector<Cell> cells;  ///< those that are not empty, by row (y), then column (x)

  /// Column and row of a place; may be outside.
  Eigen::Vector2i index(const Eigen::Vector2f& p) const;
};

/// Of points in a level frame whose ground is at ground_m. reach_m is half the square's side.
BirdsEye birds_eye(const PointCloud& points, double ground_m, double reach_m);
inline constexpr int kBirdsEyeSide = 120;

/// A square of values, by row.
struct BirdsEyeImage {
  int side = 0;
  std::vector<float> values;
  float at(int x, int y) const {
    return x < 0 || y < 0 || x >= side || y >= side
               ? 0.0F
               : values[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)];
  }
};
BirdsEyeImage image_of(const BirdsEye& view);

}  // namespace cmap
