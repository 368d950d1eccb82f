#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "cmap/core/sampled_indices.hpp"
#include "cmap/geometry/point_cloud.hpp"

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

/// The core of a cloud, and how far around it a point is no stray. Fewer than kFewestForCore points have no strays:
/// their core are their bounds.
struct CloudCore {
  Box3d box;
  double reach_m;

  bool is_stray(const Eigen::Vector3d& x) const { return distance_to(box, x) > reach_m; }
  /// Whether a box with these points in it ends at strays.
  bool is_stretched(const Box3d& bounds) const { return is_stray(bounds.min) || is_stray(bounds.max); }
};

/// Of a sample of a cloud's points. Throws std::invalid_argument if empty.
CloudCore cloud_core(const std::vector<Eigen::Vector3d>& sample);

/// Of a cloud of n points, point_at(i) being the world position of one.
template <class PointAt>
CloudCore cloud_core(std::size_t n, PointAt&& point_at) {
  std::vector<Eigen::Vector3d> sample;
  for (const std::size_t i : sampled_indices(n, kCoreSample)) sample.push_back(point_at(i));
  return cloud_core(sample);
}

/// The origin of a cloud with these bounds, `core` being its core: choose_origin of the bounds, or of the core where
/// strays stretch the bounds, so that a few far points do not cost all others their digits.
Eigen::Vector3d choose_origin(const Box3d& box, const CloudCore& core);

}  // namespace cmap
