#include "loops/drift_bound.hpp"

#include <algorithm>
#include <numbers>

#include "cmap/geometry/rotation.hpp"

namespace cmap {

DriftBound drift_bound(double path_m, const LoopOptions& o) {
  constexpr double kDegree_rad = std::numbers::pi / 180.0;
  return {std::min(o.max_drift_m, o.drift_m + o.drift_share * path_m),
          kDegree_rad * std::min(o.max_drift_deg, o.drift_deg + o.drift_deg_per_km * path_m / 1000.0)};
}

MotionDifference difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return {(a.translation() - b.translation()).norm(), rotation_angle_rad(a.linear().transpose() * b.linear())};
}

}  // namespace cmap
