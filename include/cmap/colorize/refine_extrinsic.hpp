#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "cmap/colorize/colorize.hpp"

namespace cmap {

struct RefineOptions {
  int most_images = 48;      ///< that are kept in memory, as gray levels
  int run_length = 8;        ///< images one after the other, which share points
  double step_m = 0.3;       ///< an image joins that is so far from the last one
  double step_deg = 3.0;     ///< or turned by so much
  int most_points = 30'000;  ///< spread over the map; of those that least_views images see
  int least_views = 3;
  double largest_start_error_deg = 1.0;  ///< that is looked for: how coarse the first images are
  int iterations = 40;                   ///< of each level
  double alignment_px = 0.1;             ///< to which views of one surface can be aligned
  double largest_sigma_deg = 0.2;        ///< a direction of which less is known is left as it was
  double largest_sigma_m = 0.02;         ///< likewise
};

/// An extrinsic that makes the images agree better. Vectors are in the camera's frame.
struct RefinedExtrinsic {
  Eigen::Isometry3d T_lidar_camera = Eigen::Isometry3d::Identity();
  Eigen::Vector3d turn_deg = Eigen::Vector3d::Zero();  ///< rotation vector of the change
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();   ///< translation of the change: start * (turn, shift) = refined
  Eigen::Vector3d turn_sigma_deg = Eigen::Vector3d::Zero();  ///< standard deviations
  Eigen::Vector3d shift_sigma_m = Eigen::Vector3d::Zero();
  /// Mean distance of a point's gray levels from their mean, gains taken off, in unit gray: over the same points and
  /// views, before and after.
  double inconsistency_before = 0.0, inconsistency_after = 0.0;
  std::size_t n_images = 0, n_points = 0, n_views = 0;
  std::vector<std::string> free_axes;  ///< of the directions that the images do not tell: "shift z"
  bool improved = false;               ///< else T_lidar_camera is the start's
};

/// The extrinsic near T_lidar_camera of the images for which the images agree best about the points of the map: with
/// a_pi the gray level where image i shows point p, divided by the image's gain, it minimizes
///     sum_p sum_i w_pi rho((a_pi - mean_j a_pj) / sigma)
/// over the six parameters of T_lidar_camera Exp(turn, shift): Gauss-Newton with Levenberg's damping and Cauchy's rho,
/// w the view_weight(), on images from coarse to fine (as in Zhou, Koltun 2014, "Color Map Optimization for 3D
/// Reconstruction with Consumer Depth Cameras"). Which image sees which point is decided anew at every level, as in
/// colorize(). Standard deviations take it that views of one surface can be aligned to alignment_px and no better,
/// however many they are. Views from a straight way without turns hardly tell where the camera sits: directions above
/// largest_sigma_deg, largest_sigma_m are left as they were, and said. Memory: of each kept image six bytes a
/// pixel. Throws UnsupportedError where fewer than 100 points are seen by enough images, or no direction is told; what
/// colorize() throws. The same for any number of threads. Thread-safe.
RefinedExtrinsic refine_extrinsic(const PointCloud& map, const PosedImages& images, const ColorizeOptions& options = {},
                                  const RefineOptions& refine = {});

}  // namespace cmap
