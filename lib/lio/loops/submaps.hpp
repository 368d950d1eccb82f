#pragma once

#include <span>
#include <vector>

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/lio/keyframe.hpp"
#include "cmap/lio/loop_options.hpp"

namespace cmap {

/// Length of the path from the first keyframe to each.
std::vector<double> path_lengths_m(std::span<const Keyframe> keyframes);

/// A stretch of the path: keyframes [first, last] about the one at its center.
struct Submap {
  std::size_t center = 0, first = 0, last = 0;
  double path_m = 0.0;  ///< of the center
};

/// Submaps along the path, centers submap_spacing_m apart; those without a point are left out.
std::vector<Submap> submaps_of(std::span<const Keyframe> keyframes, std::span<const double> paths_m,
                               const LoopOptions& options);

/// A keyframe's level frame: at the body, z up, x in the heading of the body's x axis.
Eigen::Isometry3d level_frame(const Eigen::Isometry3d& T_world_body);

/// A submap's points in the level frame of its center, thinned to a voxel; origin zero. At most kMostKeyframes take
/// part, evenly, as a sensor at rest sees one thing over and over.
PointCloud points_of(const Submap& submap, std::span<const Keyframe> keyframes, double voxel_m);
inline constexpr std::size_t kMostKeyframes = 40;

/// Height of the ground about a submap's center: the 5 % quantile of the heights. Throws std::invalid_argument where
/// there are no points.
double ground_height_m(const PointCloud& points);

}  // namespace cmap
