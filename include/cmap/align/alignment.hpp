#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cmap/align/verdict.hpp"

namespace cmap {

/// What a registration found, and how far to trust it.
struct Alignment {
  std::string method;
  Eigen::Matrix4d T_dst_src = Eigen::Matrix4d::Identity();  ///< maps source points to the target's frame, world frames
  double scale = 1.0;                                       ///< of T_dst_src

  double overlap = 0.0;      ///< share of the (thinned) source with a target point within max_distance_m
  double rmse_m = 0.0;       ///< of the distances of those points to their nearest target points
  std::size_t n_source = 0;  ///< points of the source that took part
  std::size_t n_target = 0;
  std::size_t n_matches = 0;  ///< those within max_distance_m

  /// Smallest over largest eigenvalue of the information matrix at the result: sum J^T J over the matches, J the
  /// derivative of the distance to the target's surface by rotation, translation and, where it was estimated, log
  /// scale. Rotation and scale are measured by what they move a point at the matches' RMS distance from their centroid,
  /// so that all are in meters. 0: something is undetermined.
  double condition = 0.0;
  std::string weakest;  ///< the direction of the smallest eigenvalue: "rotation about (0.00, 0.00, 1.00)"

  /// Of the translation and the rotation along their axes, and the scale where it was estimated, the worst first: from
  /// the information matrix, the matches' distances to the target's surface, and how far these are from independent.
  std::vector<WeakDirection> standard_errors;

  int iterations = 0;      ///< of all levels
  bool converged = false;  ///< the last level ended before its most iterations

  double voxel_m = 0.0;         ///< of the last level, in the target's units; 0: not thinned
  double max_distance_m = 0.0;  ///< of the last level
  Judgment judgment;
  std::vector<std::string> warnings;
};

}  // namespace cmap
