#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cmap/metrics/geometry.hpp"
#include "cmap/metrics/order_statistics.hpp"
#include "cmap/metrics/peers.hpp"

namespace cmap {
namespace {

/// The voxel with its covariance's eigenvalues raised to 1e-6 m^2.
Gaussian raised(Gaussian voxel) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(voxel.covariance());
  const Eigen::Vector3d values = solver.eigenvalues().cwiseMax(1e-6) * static_cast<double>(voxel.n - 1);
  voxel.scatter = solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
  return voxel;
}

double raised_distance(const GaussianPair& pair) {
  const Gaussian a = raised(pair.reference), b = raised(pair.estimate);
  const double distance_m = wasserstein_distance(a, b);
  const double traces = a.covariance().trace() + b.covariance().trace();
  return distance_m * distance_m <= 1e-12 * std::max(traces, 1.0) ? 0.0 : distance_m;
}

}  // namespace

double cloudanalyzer_share_within(std::span<const double> sq_dist, double threshold_m) {
  const auto n = std::ranges::count_if(sq_dist, [&](double sq) { return std::sqrt(sq) <= threshold_m; });
  return static_cast<double>(n) / static_cast<double>(sq_dist.size());
}

CloudAnalyzerCurve cloudanalyzer_curve(std::span<const double> sq_dist_estimate,
                                       std::span<const double> sq_dist_reference) {
  CloudAnalyzerCurve curve;
  for (double t : kCloudAnalyzerThresholds_m) {
    const double precision = cloudanalyzer_share_within(sq_dist_estimate, t);
    const double recall = cloudanalyzer_share_within(sq_dist_reference, t);
    curve.scores.push_back({t, precision, recall, f_score(precision, recall)});
  }
  for (std::size_t i = 1; i < curve.scores.size(); ++i) {
    const CloudAnalyzerScore &a = curve.scores[i - 1], &b = curve.scores[i];
    curve.auc += 0.5 * (b.threshold_m - a.threshold_m) * (a.f1 + b.f1);
  }
  curve.auc /= curve.scores.back().threshold_m - curve.scores.front().threshold_m;
  return curve;
}

CloudAnalyzerSummary cloudanalyzer_summary(std::span<const double> sq_dist) {
  const auto n = static_cast<double>(sq_dist.size());
  std::vector<double> distances;
  CloudAnalyzerSummary summary{0.0, 0.0, 0.0, 0.0};
  for (double sq : sq_dist) {
    distances.push_back(std::sqrt(sq));
    summary.mean_m += distances.back() / n;
    summary.max_m = std::max(summary.max_m, distances.back());
  }
  double variance = 0.0;
  for (double d : distances) variance += (d - summary.mean_m) * (d - summary.mean_m) / n;
  summary.standard_deviation_m = std::sqrt(variance);
  summary.median_m = quantiles(distances, std::array{0.5}).front();
  return summary;
}

CloudAnalyzerStructure cloudanalyzer_structure(std::span<const GaussianPair> pairs, int radius_voxels) {
  std::vector<VoxelDistance> distances, ones;
  for (const GaussianPair& pair : pairs) {
    distances.push_back({pair.index, raised_distance(pair)});
    ones.push_back({pair.index, 1.0});
  }
  const std::vector<double> variations = local_variations(distances, radius_voxels);
  const std::vector<double> others = local_variations(ones, radius_voxels);  // NaN where a voxel has no others
  double sum = 0.0;
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < variations.size(); ++i) {
    if (std::isnan(others[i])) continue;
    ++n;
    sum += std::isnan(variations[i]) ? 0.0 : variations[i];
  }
  return {mean_distance(distances), sum / static_cast<double>(n), distances.size(), n};
}

}  // namespace cmap
