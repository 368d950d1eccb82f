#pragma once

// What other tools print, to lay beside our own numbers (METRICS, "What other tools print"). Every function is pure;
// distances are squared nearest distances in m^2, NaN stands for "no value".

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cmap/metrics/wasserstein.hpp"
#include "cmap/spatial/radius.hpp"

namespace cmap {

/// MapEval 1.0 with its initial matrix only: correspondences are d^2 <= overlap_distance_m (the tool compares a square
/// with meters); AC = sqrt(sum_{d <= t} d^2 / correspondences), COM = #(d <= t) / #estimate.
struct MapEvalAccuracy {
  std::vector<double> accuracy_m;  ///< per threshold
  std::vector<double> completeness;
  std::uint64_t n_correspondences = 0;
};
MapEvalAccuracy mapeval_accuracy(std::span<const double> sq_dist, std::span<const double> thresholds_m,
                                 double overlap_distance_m);

/// MapEval's voxel distances: covariance scatter / (n - 1)^3 (n > 10; else divided once), eigenvalues raised to 1e-6,
/// and a Cholesky factor in place of the matrix root. Their mean is its AWD, spatial_consistency() its SCS.
std::vector<VoxelDistance> mapeval_wasserstein_distances(std::span<const GaussianPair> pairs);

/// MapEval's mean map entropy: 1/2 ln(2 pi e det C) over the points of at least min_neighbors neighbors whose det C is
/// above 0.
struct MapEvalEntropy {
  double value;
  std::uint64_t n_valid;
};
MapEvalEntropy mapeval_entropy(const NeighborhoodShape& shape, std::uint64_t min_neighbors);

/// Open3D's evaluate_registration: strict d < t; RMSE over the inliers, 0 without any.
struct Open3dRegistration {
  double fitness;
  double inlier_rmse_m;
  std::uint64_t n_correspondences;
};
Open3dRegistration open3d_registration(std::span<const double> sq_dist, double threshold_m);

/// CloudCompare's cloud-to-cloud distance: mean and population standard deviation of d rounded to float.
struct CloudCompareDistance {
  double mean_m;
  double standard_deviation_m;
};
CloudCompareDistance cloudcompare_distance(std::span<const double> sq_dist);

/// CloudAnalyzer 0.6.0, `evaluate`: F at its thresholds, and the area under it (trapezoids over the thresholds, divided
/// by their range).
inline constexpr std::array kCloudAnalyzerThresholds_m{0.05, 0.1, 0.2, 0.3, 0.5, 1.0};
struct CloudAnalyzerScore {
  double threshold_m, precision, recall, f1;
};
struct CloudAnalyzerCurve {
  std::vector<CloudAnalyzerScore> scores;
  double auc = 0.0;
};
CloudAnalyzerCurve cloudanalyzer_curve(std::span<const double> sq_dist_estimate,
                                       std::span<const double> sq_dist_reference);

/// Its share of distances d <= threshold_m.
double cloudanalyzer_share_within(std::span<const double> sq_dist, double threshold_m);

/// Its summary of one direction's distances; the standard deviation is the population's.
struct CloudAnalyzerSummary {
  double mean_m, median_m, max_m, standard_deviation_m;
};
CloudAnalyzerSummary cloudanalyzer_summary(std::span<const double> sq_dist);

/// Its `map-evaluate`: AWD with the covariances' eigenvalues raised to 1e-6, SCS in which a voxel among voxels of
/// distance 0 counts as 0. NaN without voxels.
struct CloudAnalyzerStructure {
  double awd_m, scs;
  std::uint64_t n_awd_voxels, n_scs_voxels;
};
CloudAnalyzerStructure cloudanalyzer_structure(std::span<const GaussianPair> pairs, int radius_voxels);

/// A cloud as MPEG's pc_error stores it: float positions, 8-bit colors.
struct MpegCloud {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Rgb8> rgb;
};

/// pc_error, point to point and color: equal positions merged, the colors of neighbors whose consecutive squared
/// distances differ by less than 1e-8 averaged and rounded, BT.709 in [0,1].
struct MpegDirection {
  double point_mse_m2 = 0.0;
  double sq_hausdorff_m2 = 0.0;
  std::array<double, 3> color_mse{};      ///< Y, Cb, Cr
  std::array<double, 3> color_psnr_db{};  ///< 10 log10(1 / mse), infinite for mse 0
};
struct MpegDistortion {
  MpegDirection reference_to_estimate;
  MpegDirection estimate_to_reference;
  MpegDirection symmetric;  ///< the worse of the two, value by value
};

/// Throws std::invalid_argument unless both clouds hold a point and one color per position.
MpegDistortion mpeg_distortion(const MpegCloud& reference, const MpegCloud& estimate);

}  // namespace cmap
