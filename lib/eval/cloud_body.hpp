#pragma once

#include <cstdint>

#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// Where nearly all points of a cloud are, whatever a few of them do; world frame, meters.
struct CloudBody {
  std::uint64_t n = 0;         ///< points
  Box3d all;                   ///< bounds of all points
  Box3d core;                  ///< from the 1st to the 99th percentile of every axis, of at most 10,000 points
  Box3d box;                   ///< bounds of all points but the strays
  std::uint64_t n_strays = 0;  ///< points farther from the core than ten of its diagonals
  std::size_t farthest = 0;    ///< the stray that is farthest from the core
  double farthest_m = 0.0;     ///< its distance from the core

  double core_diagonal_m() const { return (core.max - core.min).norm(); }
};

/// Throws std::invalid_argument on an empty cloud. Fewer than ten points have no strays.
CloudBody body_of(const PointCloud& cloud);

/// Length of the shortest way between two boxes, 0 where they meet.
inline double gap_between(const Box3d& a, const Box3d& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm();
}

}  // namespace cmap
