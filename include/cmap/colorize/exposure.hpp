#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "cmap/colorize/observations.hpp"

namespace cmap {

/// How images are brought to one exposure.
enum class ExposureModel {
  kNone,
  kGain,      ///< one factor for each image
  kChannels,  ///< one for each channel of each image: white balance too
};

struct ExposureOptions {
  ExposureModel model = ExposureModel::kGain;
  std::size_t most_points = 20'000;    ///< of the map, spread over it; more where images are many
  std::size_t points_per_image = 200;  ///< at least, where there are so many
  double sigma_gain = 0.5;             ///< of the logarithm: how far gains are believed to lie from 1
  double least_sigma = 0.02;           ///< of the logarithm of an observation
  int darkest = 8, brightest = 247;    ///< levels outside have lost what they were
  int passes = 8;                      ///< of reweighting
};

/// The gain of each image by channel (rows r, g, b; all alike with kGain), such that color / gain is comparable. With
/// observation o of point p in image i as the level I_o, gains g_i and colors c_p minimize
///     sum_o rho((log I_o - log g_i - log c_p) / sigma) + sum_i (log g_i / sigma_gain)^2
/// with Cauchy's rho by reweighting and sigma from the median residual of each pass; colors are eliminated, so that the
/// gains of all images are solved at once (Cholesky). The median of each channel's gains is then set to 1: the map
/// keeps the exposure of the middle image. An image without shared points has gain 1, or the middle one's. A level is a
/// gamma-coded number: a factor on the light is, to that approximation, a factor on it, too. Deterministic.
/// Thread-safe.
Eigen::Matrix3Xd exposure_gains_of(const Observations& observations, std::size_t n_images,
                                   const ExposureOptions& options);

}  // namespace cmap
