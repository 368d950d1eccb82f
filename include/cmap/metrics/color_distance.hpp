#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "cmap/metrics/map_pair.hpp"

namespace cmap {

// All of these need colors in both maps (std::invalid_argument otherwise), pair every point with its nearest neighbor
// in space, and are bitwise the same for any number of threads. Pairs in which either point has no color (NaN) are left
// out. A mean over no pairs is NaN. Distances are compared as METRICS means thresholds (spatial/threshold.hpp).

/// Mean RGB distance of nearest pairs in one direction.
struct DirectedColorDistance {
  double mean = 0.0;  ///< unit RGB
  std::uint64_t n = 0;
  std::uint64_t n_unmatched = 0;  ///< pairs left out: too far apart, or without both colors
};

/// Color distance CD (paper): the mean of both directed means, in unit RGB.
struct ColorDistance {
  DirectedColorDistance estimate_to_reference;
  DirectedColorDistance reference_to_estimate;
  double value() const { return 0.5 * (estimate_to_reference.mean + reference_to_estimate.mean); }
};

/// Which pairs count: min_distance_m < d <= max_distance_m (a negative minimum includes d = 0), and per-channel gains
/// on the estimate's colors.
struct ColorDistanceOptions {
  double min_distance_m = -1.0;
  double max_distance_m = INFINITY;
  Eigen::Vector3d estimate_gain = Eigen::Vector3d::Ones();
};
ColorDistance color_distance(const MapPair& pair, const ColorDistanceOptions& options = {});

/// Color fidelity CF = -20 log10(CD) in dB, CD in unit RGB; infinite for CD = 0.
double color_fidelity_db(double color_distance);

/// The best exposure: per channel the median of c_ref / c_est over estimate-to-reference pairs no farther than
/// max_distance_m, zeros left out, unclipped. NaN without pairs.
struct ExposureGains {
  Eigen::Vector3d gain;
  std::uint64_t n_pairs = 0;  ///< pairs within max_distance_m
};
ExposureGains exposure_gains(const MapPair& pair, double max_distance_m);

/// Mean squared Y, Cb, Cr differences (BT.709, unit range) of nearest pairs, both directions.
struct ColorPsnr {
  Eigen::Vector3d mse_estimate_to_reference;
  Eigen::Vector3d mse_reference_to_estimate;
  /// 10 log10(1 / mse) of the worse direction, per channel; infinite where both are 0 (below 1e-24: rounding noise),
  /// NaN where a direction has no pairs.
  Eigen::Vector3d psnr_db() const;
};
ColorPsnr color_psnr(const MapPair& pair);

/// CIEDE2000 of one point and its nearest neighbor; NaN where either has no color.
double delta_e(const NearestPairs& pairs, std::size_t slot);

/// CIEDE2000 of nearest pairs no farther than max_distance_m. NaN without pairs.
struct DeltaEStats {
  double mean, median, p95;
  std::uint64_t n;
};
DeltaEStats delta_e(const NearestPairs& pairs, double max_distance_m);

}  // namespace cmap
