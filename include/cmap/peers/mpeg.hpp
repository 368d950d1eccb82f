#pragma once

// What another tool prints, to lay beside our own numbers (METRICS, "What other tools print"). Every function is
// pure; distances are squared nearest distances in m^2, NaN stands for "no value".

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

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
