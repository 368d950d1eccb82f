#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "column_map.hpp"
#include "registration_cloud.hpp"

namespace cmap {

/// A map as poses are judged on it: some of its points with what they are like, all of its fine points to meet, and
/// the plan of where it was seen.
class WitnessMap {
 public:
  /// What chance agreement depends on: surfaces that face up, sideways or between, and what is no surface; near the
  /// ground or above.
  static constexpr std::size_t kClasses = 8;

  struct Sizes {
    double fine_voxel_m;
    double block_m;  ///< points of one class in such a cube are one witness
    std::size_t most_points = 3000;
  };

  WitnessMap(const PointCloud& cloud, const ColumnMap& columns, const Sizes& sizes);

  struct Witness {
    Eigen::Vector3f normal;  ///< zero: no surface
    float weight;            ///< those of a block's class sum to one at most
    std::uint8_t kind;       ///< its class
  };

  /// Whether the map was seen where this point is, in its own frame.
  bool was_seen_at(const Eigen::Vector3d& p) const;

  const ColumnMap& columns;
  RegistrationTarget fine;
  double spacing_m = 0.0;  ///< of the fine points, median
  std::vector<Witness> witnesses;  ///< by slot of `points`
  MovingSource points;             ///< those that witness

 private:
  PointCloud choose(const Sizes& sizes);
  void weigh(double block_m);
};

/// Whether a normal is that of a surface: points spread across it far less than along.
bool is_surface(const Surface& surface, std::size_t slot);

}  // namespace cmap
