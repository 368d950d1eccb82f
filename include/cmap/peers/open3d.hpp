#pragma once

// What another tool prints, to lay beside our own numbers (METRICS, "What other tools print"). Every function is
// pure; distances are squared nearest distances in m^2, NaN stands for "no value".

#include <cstdint>
#include <span>

namespace cmap {

/// Open3D's evaluate_registration: strict d < t; RMSE over the inliers, 0 without any.
struct Open3dRegistration {
  double fitness;
  double inlier_rmse_m;
  std::uint64_t n_correspondences;
};
Open3dRegistration open3d_registration(std::span<const double> sq_dist, double threshold_m);

}  // namespace cmap
