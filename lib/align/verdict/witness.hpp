#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "global/column_map.hpp"
#include "icp/registration_cloud.hpp"

namespace cmap {

/// A map's points as finely as poses are judged, with their surface.
struct FineMap {
  FineMap(const PointCloud& cloud, double voxel_m);
  /// Whether points spread across a slot's normal far less than along; the slot must have been fitted.
  bool is_surface(std::size_t slot) const;

  RegistrationTarget points;
  double spacing_m = 0.0;  ///< of neighbors, median
};

/// Some of a map's points, with what they are like: poses are judged by what of the other map they meet.
class WitnessMap {
 public:
  /// What chance agreement depends on: surfaces that face up, sideways or between, and what is no surface; near the
  /// ground or above.
  static constexpr std::size_t kClasses = 8;

  struct Witness {
    Eigen::Vector3f normal;  ///< zero: no surface
    float weight;            ///< those of a class in one block sum to one at most
    std::uint8_t kind;       ///< its class
  };

  /// The plan's frame says what faces up. `block_m`: the side of blocks. Both maps must outlive it.
  WitnessMap(FineMap& fine, const ColumnMap& plan, double block_m);

  FineMap& fine() { return fine_; }
  const ColumnMap& plan() const { return plan_; }
  const PointBlocks& points() const { return points_; }
  const Witness& operator[](std::size_t slot) const { return witnesses_[slot]; }
  std::size_t size() const { return witnesses_.size(); }
  /// Whether the map was seen where this point is, in its own frame.
  bool was_seen_at(const Eigen::Vector3d& p) const;

 private:
  std::uint8_t kind_of(const Eigen::Vector3d& p, const Eigen::Vector3f& normal) const;
  void weigh(double block_m);

  FineMap& fine_;
  const ColumnMap& plan_;
  PointBlocks points_;
  std::vector<Witness> witnesses_;  ///< by slot of points_
};

}  // namespace cmap
