#pragma once

#include <Eigen/Geometry>

#include "cmap/lio/loop_options.hpp"

namespace cmap {

/// What odometry may be off by over a path.
struct DriftBound {
  double m = 0.0, rad = 0.0;
};
DriftBound drift_bound(double path_m, const LoopOptions& options);

/// How far two motions between the same frames differ: their translations, and their rotations.
struct MotionDifference {
  double m = 0.0, rad = 0.0;
  bool within(const DriftBound& bound) const { return m <= bound.m && rad <= bound.rad; }
};
MotionDifference difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

}  // namespace cmap
