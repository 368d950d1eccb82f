#pragma once

#include <Eigen/Core>
#include <vector>

#include "filter/plane_rows.hpp"

namespace cmap {

/// What the planes that a scan met say of where it is.
struct PlaneDirections {
  std::vector<Eigen::Vector3f> normals;  ///< world
  std::vector<Eigen::Vector3f> turns;    ///< axes that each plane resists a turn about: body at the end, unit
  std::vector<float> sq_tilts;           ///< variances of the normals' slopes, the larger of each

  void add(const Eigen::Vector3f& normal, const PoseVector& jacobian, float sq_tilt) {
    normals.push_back(normal);
    turns.push_back(jacobian.head<3>().normalized().cast<float>());
    sq_tilts.push_back(sq_tilt);
  }
};

/// Directions that the surfaces leave open: along a corridor, over flat ground, one wall only.
struct OpenDirections {
  std::vector<Eigen::Vector3d> shifts;  ///< unit, world
  std::vector<Eigen::Vector3d> turns;   ///< unit axes, body at the end
  bool any() const { return !shifts.empty() || !turns.empty(); }
};

/// A direction is open unless surfaces that stand across it count as many as `least_points`: the sum of the squared
/// cosines of those whose cosine is above three standard deviations of their normal, and 0.01. Normals that are off by
/// less, of a surface along the direction, are noise and hold nothing, however many they are; gentle slopes of fields,
/// whose normals are well known, do hold a sensor that looks down.
OpenDirections open_directions(const PlaneDirections& directions, double least_points);

/// Takes out of the system what it says of open directions, so that the prior alone decides there (Zhang, Kaess and
/// Singh 2016).
void remove_open(PlaneSystem& system, const OpenDirections& open);

}  // namespace cmap
