#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>

namespace cmap {

/// How the scales of neighboring sessions are compared.
enum class OverlapScale {
  kDepths,   ///< by the depths of the same pixels
  kCenters,  ///< the paper's: by the camera centers of shared frames
};

/// Scale of a session over that of the one before it, s_{k+1} / s_k.
struct ScaleRatio {
  double ratio = 1.0;
  double sigma_log = 0.0;  ///< standard deviation of its logarithm
  std::size_t n = 0;       ///< pixels, or camera centers, that it is from
};

/// What two sessions predict for the pixels of an image in both, row by row; equally many of each.
struct SharedFrame {
  std::span<const float> depth_before, confidence_before;  ///< session k, its unit
  std::span<const float> depth_after, confidence_after;    ///< session k + 1
};

/// The median of depth_before / depth_after over all pixels where both confidences are at least the median of their
/// frame, since s_k d_k = s_{k+1} d_{k+1}; sigma is 1.4826 times the median deviation of the logarithms, not lowered by
/// the number of pixels, whose errors go together. Depths that are not finite and positive do not count; none with
/// fewer than min_pixels. Thread-safe. Throws std::invalid_argument where lengths differ.
std::optional<ScaleRatio> scale_ratio_of_depths(std::span<const SharedFrame> frames, int min_pixels = 100);

/// The paper's: Umeyama's scale from the camera centers of the shared frames in session k + 1 to those in session k.
/// None for fewer than three frames, or centers that do not determine it.
std::optional<ScaleRatio> scale_ratio_of_centers(std::span<const Eigen::Vector3d> centers_before,
                                                 std::span<const Eigen::Vector3d> centers_after);

}  // namespace cmap
