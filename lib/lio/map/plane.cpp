#include "map/plane.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cmap {

std::optional<Plane> fit_plane(const PointSums& sums, const Eigen::Vector3d& origin, double cell_m,
                               const PlaneRule& rule) {
  if (sums.n < rule.least_points) return std::nullopt;
  const Eigen::Vector3d mean = sums.sum / sums.n;
  Eigen::Matrix3d covariance;
  covariance << sums.xx, sums.xy, sums.xz, sums.xy, sums.yy, sums.yz, sums.xz, sums.yz, sums.zz;
  covariance = covariance / sums.n - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(covariance);
  const Eigen::Vector3d variances = axes.eigenvalues().cwiseMax(0.0);
  const double across = std::sqrt(variances[0]);
  if (across > std::min(rule.most_thickness_m, rule.most_cell_share * cell_m)) return std::nullopt;
  if (across > rule.most_spread_share * std::sqrt(variances[1]) || variances[1] <= 0.0) return std::nullopt;
  if (variances[1] < rule.least_spread_m * rule.least_spread_m) return std::nullopt;
  // Of n points in a plane, n - 3 say how thick it is.
  const double thickness = variances[0] * sums.n / std::max(1.0, sums.n - 3.0);
  const double variance = std::max(sums.variance / sums.n, thickness);
  Plane plane;
  plane.center = origin + mean;
  plane.normal = axes.eigenvectors().col(0).cast<float>();
  plane.short_axis = axes.eigenvectors().col(1).cast<float>();
  plane.long_axis = axes.eigenvectors().col(2).cast<float>();
  plane.short_variance = static_cast<float>(variances[1]);
  plane.long_variance = static_cast<float>(variances[2]);
  plane.offset_variance = static_cast<float>(variance / sums.n);
  plane.short_slope_variance = static_cast<float>(variance / (sums.n * variances[1]));
  plane.long_slope_variance = static_cast<float>(variance / (sums.n * variances[2]));
  return plane;
}

}  // namespace cmap
