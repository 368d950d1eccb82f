#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace cmap {

/// A direction, either sign, that many surfaces of a map face.
struct MainAxis {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double share = 0.0;  ///< of the normals within 12 degrees
};

/// The directions that most normals share, at most three, the most frequent first, each more than 45 degrees from those
/// before; normals may have either sign, and zeros do not count. Where nothing has a normal: none.
std::vector<MainAxis> main_axes(std::span<const Eigen::Vector3f> normals);

}  // namespace cmap
