#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "cmap/core/point_cloud.hpp"

namespace cmap {

/// As many points as tell where nearly all of a cloud's points are.
inline constexpr std::size_t kCoreSample = 10000;
/// With fewer points, every one may be an end of the map.
inline constexpr std::size_t kFewestForCore = 10;
/// Points farther from the core than so many of its diagonals are strays.
inline constexpr double kStrayDiagonals = 10.0;

/// Where nearly all points are: the box without the outermost hundredth (one point at least) on either side of every
/// axis. Throws std::invalid_argument on fewer than kFewestForCore points.
Box3d core_box(const std::vector<Eigen::Vector3d>& sample);

/// Distance of a point from a box, 0 inside.
inline double distance_to(const Box3d& box, const Eigen::Vector3d& x) {
  return (box.min - x).cwiseMax(x - box.max).cwiseMax(0.0).norm();
}

/// Farthest distance from the core at which a point is no stray; infinite for a core without extent.
double stray_reach_m(const Box3d& core);

/// The origin of a cloud with these bounds, `sample` being some of its points, evenly taken (sampled_indices with
/// kCoreSample): choose_origin of the bounds, or of the core where strays stretch the bounds, so that a few far points
/// do not cost all others their digits.
Eigen::Vector3d choose_origin(const Box3d& box, const std::vector<Eigen::Vector3d>& sample);

}  // namespace cmap
