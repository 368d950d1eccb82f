#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "cmap/spatial/k_nearest.hpp"
#include "loops/plane_grid.hpp"

namespace cmap::test {

/// Standard deviation of points across the plane through them; a plane takes three of their freedoms, without which few
/// points would make thinner walls than many.
inline double sigma_across_m(const std::vector<Eigen::Vector3d>& points) {
  const auto n = static_cast<double>(points.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p / n;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) moments += (p - mean) * (p - mean).transpose() / (n - 3.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, axes.eigenvalues()[0]));
}

/// Of every patch of wall with enough points, the standard deviation of a cloud's points near them across a plane of
/// their own: within 0.25 m of the patch's middle along it, and 0.3 m across, so that a double wall counts whole.
inline std::vector<double> wall_thickness_m(const PointCloud& cloud, const PlaneGrid& walls) {
  constexpr double kAlong_m = 0.25, kAcross_m = 0.3;
  constexpr std::size_t kFewest = 6, kNeighbors = 64;
  const Bvh index(sort_points(cloud));
  PointCloud middles;
  for (const PlanePatch& wall : walls.patches()) middles.positions.push_back(wall.mean.cast<float>());
  const PointBlocks queries = sort_points(middles);
  const Array<std::uint32_t> nearest = find_k_nearest(index, queries, kNeighbors);
  std::vector<double> all;
  for (std::size_t slot = 0; slot < queries.size; ++slot) {
    const PlanePatch& wall = walls.patches()[queries.original_index[slot]];
    std::vector<Eigen::Vector3d> points;
    for (std::size_t k = 0; k < kNeighbors; ++k) {
      const std::uint32_t neighbor = nearest[slot * kNeighbors + k];
      if (neighbor == kNoNeighbor) break;
      const Eigen::Vector3d from_middle = index.points.world(neighbor) - wall.mean;
      const double across_m = wall.normal.dot(from_middle);
      const double along_m = (from_middle - across_m * wall.normal).norm();
      if (std::abs(across_m) <= kAcross_m && along_m <= kAlong_m) points.push_back(index.points.world(neighbor));
    }
    if (points.size() >= kFewest) all.push_back(sigma_across_m(points));
  }
  return all;
}

}  // namespace cmap::test
