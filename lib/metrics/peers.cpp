#include "cmap/metrics/peers.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "cmap/core/parallel.hpp"
#include "metrics/counted_sum.hpp"

namespace cmap {
namespace {

double ratio(double sum, std::uint64_t n) { return sum / static_cast<double>(n); }

/// Division by n - 1 on building the voxel, in its entropy (both for n > 10 only) and in the distance.
Eigen::Matrix3d mapeval_covariance(const Gaussian& voxel) {
  const auto m = static_cast<double>(voxel.n - 1);
  const Eigen::Matrix3d sigma = voxel.scatter / (voxel.n > 10 ? m * m * m : m);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sigma);
  const Eigen::Vector3d clamped = solver.eigenvalues().cwiseMax(1e-6);
  return solver.eigenvectors() * clamped.asDiagonal() * solver.eigenvectors().transpose();
}

double mapeval_wasserstein(const Gaussian& reference, const Gaussian& estimate) {
  const Eigen::Matrix3d cov_ref = mapeval_covariance(reference);
  const Eigen::Matrix3d cov_est = mapeval_covariance(estimate);
  const Eigen::Matrix3d factor = cov_ref.llt().matrixL();
  const Eigen::Matrix3d product = factor * cov_est * factor.transpose();
  const Eigen::Matrix3d root = product.llt().matrixL();
  const double sq =
      (reference.mean - estimate.mean).squaredNorm() + cov_ref.trace() + cov_est.trace() - 2 * root.trace();
  return std::sqrt(std::max(0.0, sq));
}

}  // namespace

MapEvalAccuracy mapeval_accuracy(std::span<const double> sq_dist, std::span<const double> thresholds_m,
                                 double overlap_distance_m) {
  std::vector<double> sum(thresholds_m.size(), 0.0);
  std::vector<std::uint64_t> inside(thresholds_m.size(), 0);
  MapEvalAccuracy result;
  for (const double sq : sq_dist) {
    if (sq > overlap_distance_m) continue;
    ++result.n_correspondences;
    const double distance = std::sqrt(sq);
    for (std::size_t k = 0; k < thresholds_m.size(); ++k) {
      if (distance > thresholds_m[k]) continue;
      sum[k] += sq;
      ++inside[k];
    }
  }
  for (std::size_t k = 0; k < thresholds_m.size(); ++k) {
    result.accuracy_m.push_back(std::sqrt(ratio(sum[k], result.n_correspondences)));
    result.completeness.push_back(ratio(static_cast<double>(inside[k]), sq_dist.size()));
  }
  return result;
}

std::vector<VoxelDistance> mapeval_wasserstein_distances(std::span<const GaussianPair> pairs) {
  std::vector<VoxelDistance> distances;
  for (const GaussianPair& pair : pairs) {
    distances.push_back({pair.index, mapeval_wasserstein(pair.reference, pair.estimate)});
  }
  return distances;
}

MapEvalEntropy mapeval_entropy(const NeighborhoodShape& shape, std::uint64_t min_neighbors) {
  const std::size_t n_points = shape.n_neighbors.size();
  const auto total = ordered_sum<CountedSum>(n_points, kLoopChunk, [&](std::size_t begin, std::size_t end) {
    CountedSum part;
    for (std::size_t i = begin; i < end; ++i) {
      // NaN, for too few neighbors, is not above 0 either.
      if (shape.n_neighbors[i] < min_neighbors || !(shape.covariance_det[i] > 0.0)) continue;
      part += {std::log(shape.covariance_det[i]), 1};
    }
    return part;
  });
  return {0.5 * (std::log(2.0 * std::numbers::pi * std::numbers::e) + ratio(total.sum, total.n)), total.n};
}

Open3dRegistration open3d_registration(std::span<const double> sq_dist, double threshold_m) {
  double sum = 0.0;
  std::uint64_t n_inliers = 0;
  for (const double sq : sq_dist) {
    if (sq >= threshold_m * threshold_m) continue;
    sum += sq;
    ++n_inliers;
  }
  if (n_inliers == 0) return {0.0, 0.0, 0};
  return {ratio(static_cast<double>(n_inliers), sq_dist.size()), std::sqrt(ratio(sum, n_inliers)), n_inliers};
}

CloudCompareDistance cloudcompare_distance(std::span<const double> sq_dist) {
  double sum = 0.0;
  double sum_sq = 0.0;
  for (const double sq : sq_dist) {
    const auto d = static_cast<double>(static_cast<float>(std::sqrt(sq)));
    sum += d;
    sum_sq += d * d;
  }
  const double mean = ratio(sum, sq_dist.size());
  return {mean, std::sqrt(std::abs(ratio(sum_sq, sq_dist.size()) - mean * mean))};
}

}  // namespace cmap
