#pragma once

// What another tool prints, to lay beside our own numbers (METRICS, "What other tools print"). Every function is
// pure; distances are squared nearest distances in m^2, NaN stands for "no value".

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cmap/metrics/wasserstein.hpp"

namespace cmap {

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

}  // namespace cmap
