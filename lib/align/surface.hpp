#pragma once

#include <Eigen/Core>

#include "cmap/spatial/bvh.hpp"

namespace cmap {

/// Local planes through a cloud's points, by slot.
struct Surface {
  /// Unit normals of either sign: the direction in which the k nearest points (the point itself included) spread least.
  /// Zero where they lie in one place or along a line, as do neighbors on one scan line of a LiDAR.
  Array<Eigen::Vector3f> normals;
  /// Variance by which noise of the points tilts the normal, rad^2: that of a least-squares plane, in its less certain
  /// direction.
  Array<float> tilt_variance;
};
Surface surface_of(const Bvh& cloud, std::size_t k);

}  // namespace cmap
