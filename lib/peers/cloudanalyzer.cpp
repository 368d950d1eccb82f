#include "cmap/peers/cloudanalyzer.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cmap/geometry/order_statistics.hpp"
#include "cmap/metrics/geometry.hpp"
#include "cmap/peers/peer_tool.hpp"
#include "distances.hpp"

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

namespace {

Record summary_record(const CloudAnalyzerSummary& s) {
  return Record{}
      .add("mean", s.mean_m)
      .add("median", s.median_m)
      .add("max", s.max_m)
      .add("std", s.standard_deviation_m);
}

Record cloudanalyzer_evaluate(const MetricInputs& inputs) {
  const std::span<const double> estimate = peer_distances(inputs, Side::kEstimate);
  const std::span<const double> reference = peer_distances(inputs, Side::kReference);
  const CloudAnalyzerCurve curve = cloudanalyzer_curve(estimate, reference);
  const CloudAnalyzerSummary forth = cloudanalyzer_summary(estimate), back = cloudanalyzer_summary(reference);
  std::vector<Record> scores;
  for (const CloudAnalyzerScore& s : curve.scores) {
    Record& score = scores.emplace_back();
    score.add("threshold", s.threshold_m).add("precision", s.precision).add("recall", s.recall).add("f1", s.f1);
  }
  Record record;
  record.add("source_points", std::uint64_t{estimate.size()}).add("target_points", std::uint64_t{reference.size()});
  record.add("chamfer_distance", 0.5 * (forth.mean_m + back.mean_m));
  record.add("hausdorff_distance", std::max(forth.max_m, back.max_m));
  record.add("f1_scores", std::move(scores)).add("auc", curve.auc);
  return record.add(
      "distance_stats",
      Record{}.add("source_to_target", summary_record(forth)).add("target_to_source", summary_record(back)));
}

/// Without voxels it prints neither AWD nor SCS.
Record cloudanalyzer_map_evaluate(const MetricInputs& inputs) {
  constexpr double kVoxel_m = 3.0;  // its defaults
  constexpr std::uint64_t kMinPoints = 100;
  constexpr int kRadiusVoxels = 5;
  constexpr std::array kThresholds_m{0.2, 0.1, 0.08, 0.05, 0.01};
  const std::span<const double> forth = peer_distances(inputs, Side::kEstimate),
                                back = peer_distances(inputs, Side::kReference);
  const double mean_forth_m = cloudanalyzer_summary(forth).mean_m, mean_back_m = cloudanalyzer_summary(back).mean_m;
  Record record;
  record.add("n_est", std::uint64_t{forth.size()}).add("n_ref", std::uint64_t{back.size()});
  record.add("mean_est_to_ref_m", mean_forth_m).add("mean_ref_to_est_m", mean_back_m);
  record.add("chamfer_m", mean_forth_m + mean_back_m);
  for (const double t : kThresholds_m) {
    record.add(fmt::format("accuracy@{:.3f}m", t), cloudanalyzer_share_within(forth, t));
    record.add(fmt::format("completeness@{:.3f}m", t), cloudanalyzer_share_within(back, t));
  }
  record.add(
      fmt::format("fscore@{:.3f}m", kThresholds_m[0]),
      f_score(cloudanalyzer_share_within(forth, kThresholds_m[0]), cloudanalyzer_share_within(back, kThresholds_m[0])));
  const CloudAnalyzerStructure structure =
      cloudanalyzer_structure(gaussian_pairs(*inputs.pair, kVoxel_m, kMinPoints), kRadiusVoxels);
  if (std::isfinite(structure.awd_m)) record.add("awd_m", structure.awd_m);
  if (std::isfinite(structure.scs)) record.add("scs", structure.scs);
  return record.add("n_awd_voxels", structure.n_awd_voxels).add("n_scs_voxels", structure.n_scs_voxels);
}

Record cloudanalyzer_record(MetricInputs& inputs, const PeerOptions&) {
  Record record;
  record.add("definition", "CloudAnalyzer 0.6.0 at its defaults: commands evaluate and map-evaluate");
  record.add("evaluate", cloudanalyzer_evaluate(inputs));
  return record.add("map-evaluate", cloudanalyzer_map_evaluate(inputs));
}

}  // namespace

namespace peers {

extern constinit const PeerTool cloudanalyzer{.name = "cloudanalyzer", .record = cloudanalyzer_record};

}  // namespace peers
}  // namespace cmap
