#include "cmap/peers/mapeval.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cmap/core/exact_sum.hpp"
#include "cmap/metrics/catalog.hpp"
#include "cmap/peers/peer_tool.hpp"
#include "distances.hpp"

namespace cmap {
namespace {

/// MapEval's least neighbors in the reference; mme-min-neighbors is the estimate's.
constexpr std::uint64_t kMapEvalReferenceNeighbors = 5;

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
    result.accuracy_m.push_back(std::sqrt(sum[k] / static_cast<double>(result.n_correspondences)));
    result.completeness.push_back(static_cast<double>(inside[k]) / static_cast<double>(sq_dist.size()));
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
  ExactSum log_det;
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < n_points; ++i) {
    // NaN, for too few neighbors, is not above 0 either.
    if (shape.n_neighbors[i] < min_neighbors || !(shape.covariance_det[i] > 0.0)) continue;
    log_det.add(std::log(shape.covariance_det[i]));
    ++n;
  }
  return {0.5 * (std::log(2.0 * std::numbers::pi * std::numbers::e) + log_det.value() / static_cast<double>(n)), n};
}

namespace {

Record mapeval_record(MetricInputs& inputs, const PeerOptions&) {
  for (const Metric* metric : {&catalog::average_wasserstein, &catalog::mean_map_entropy}) metric->prepare(inputs);
  const MetricOptions& o = inputs.options();
  const MapEvalAccuracy accuracy =
      mapeval_accuracy(peer_distances(inputs, Side::kEstimate), o.thresholds_m, o.overlap_distance_m);
  std::vector<Record> levels;
  for (std::size_t t = 0; t < o.thresholds_m.size(); ++t) {
    Record& level = levels.emplace_back(Record{.threshold_m = o.thresholds_m[t]});
    level.add("AC", accuracy.accuracy_m[t]).add("COM", accuracy.completeness[t]);
  }
  const std::vector<VoxelDistance> voxels = mapeval_wasserstein_distances(inputs.wasserstein->gaussians);
  const MapEvalEntropy estimate = mapeval_entropy(*inputs.neighborhoods.estimate, o.mme_min_neighbors);
  const MapEvalEntropy reference = mapeval_entropy(*inputs.neighborhoods.reference, kMapEvalReferenceNeighbors);
  Record record;
  record.add("definition", "MapEval 1.0.0 with its initial matrix only").add("per_threshold", std::move(levels));
  record.add("n_correspondences", accuracy.n_correspondences).add("AWD", mean_distance(voxels));
  record.add("SCS", mean_variation(local_variations(voxels, static_cast<int>(o.scs_radius_voxels))));
  record.add("n_voxels", std::uint64_t{voxels.size()});
  Record entropy;
  entropy.add("estimate", estimate.value).add("reference", reference.value);
  entropy.add("valid_estimate", estimate.n_valid).add("valid_reference", reference.n_valid);
  return record.add("MME", std::move(entropy));
}

}  // namespace

namespace peers {

extern constinit const PeerTool mapeval{.name = "mapeval", .record = mapeval_record, .reads_gaussians = true};

}  // namespace peers
}  // namespace cmap
