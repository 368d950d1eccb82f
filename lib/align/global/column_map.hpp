#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cmap {

/// What stands on each cell of a map's plan: a word of four bits, which of four layers above the local ground hold
/// points. Words do not change with turns about the vertical and shifts, whatever the height of the frame.
struct ColumnMap {
  static constexpr std::size_t kWords = 16;
  static constexpr std::uint8_t kEmpty = 0;

  /// `points` in meters, `upright` the rotation that brings their up to +z; cells lie from the lowest corner less
  /// `phase` cells on. `layer_m`: what the layers' heights, 1.5, 4 and 8 times this, are measured by.
  ColumnMap(std::span<const Eigen::Vector3f> points, const Eigen::Matrix3d& upright, double cell_m, double layer_m,
            double phase = 0.0);

  std::uint8_t word_at(int x, int y) const {
    const bool is_inside = x >= 0 && y >= 0 && x < width && y < height;
    return is_inside ? word[index_of(x, y)] : kEmpty;
  }
  /// Of a cell inside.
  float ground_at(int x, int y) const { return ground_m[index_of(x, y)]; }
  float weight_at(int x, int y) const { return weight[index_of(x, y)]; }
  /// Where a place of the upright frame lies, in cells.
  Eigen::Vector2d cell_at(const Eigen::Vector2d& place) const { return (place - low_m) / cell_m; }
  Eigen::Vector2d center() const { return low_m + 0.5 * cell_m * Eigen::Vector2d(width, height); }

  Eigen::Matrix3d upright;
  double cell_m, layer_m;
  Eigen::Vector2d low_m = Eigen::Vector2d::Zero();  ///< corner of cell (0, 0), upright frame
  int width = 0, height = 0;
  std::vector<std::uint8_t> word;  ///< by row
  std::vector<float> weight;       ///< root of how much a cell tells: little among others like it
  std::vector<float> ground_m;     ///< of the cells' surroundings, upright frame

 private:
  std::size_t index_of(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// How much more likely two words are where maps show the same place than anywhere, natural logarithm: from how often
/// words meet in two maps, and on the same map cut into other cells.
using WordScores = std::array<std::array<double, ColumnMap::kWords>, ColumnMap::kWords>;

struct RecutColumns {
  const ColumnMap& map;
  const ColumnMap& recut;  ///< the same points with another phase
};
WordScores word_scores(std::span<const RecutColumns> maps);

}  // namespace cmap
