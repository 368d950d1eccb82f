#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "cmap/metrics/map_pair.hpp"

namespace cmap {

/// The best exposure: per channel the median of c_ref / c_est over estimate-to-reference pairs no farther than
/// max_distance_m that both have a color, zeros left out, unclipped. NaN without pairs.
struct ExposureGains {
  Eigen::Vector3d gain;
  std::uint64_t n_pairs = 0;  ///< pairs within max_distance_m
};

/// Both maps need colors (std::invalid_argument).
ExposureGains exposure_gains(const MapPair& pair, double max_distance_m);

}  // namespace cmap
