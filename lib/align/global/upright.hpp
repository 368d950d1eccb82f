#pragma once

#include <Eigen/Core>
#include <vector>

#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// Which way up a map may be.
struct Ups {
  bool is_z = false;                 ///< most surfaces face the frame's own z
  std::vector<Eigen::Vector3d> all;  ///< the most plausible first
};

/// An axis, to the side of the longer tail: houses and trees stand on the ground.
Eigen::Vector3d with_longer_tail(const PointCloud& thinned, const Eigen::Vector3d& axis);

/// From the directions that the surfaces of a thinned map face, as it lies.
Ups ups_of(const PointCloud& thinned);

/// The rotation of least angle that turns a direction to +z.
Eigen::Matrix3d upright_from(const Eigen::Vector3d& up);

}  // namespace cmap
