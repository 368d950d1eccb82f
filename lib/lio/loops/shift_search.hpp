#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "loops/birds_eye.hpp"

namespace cmap {

/// How one view lies on another: x_target = R(yaw) x_source + shift.
struct PlanarPose {
  double yaw_rad = 0.0;
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();
  double score = 0.0;  ///< sum of products of the cells on each other over the product of both views' norms, 0 to 1
};

/// The shift within window_m of `about_m` (both axes, in whole cells) at which the source, turned by yaw_rad, lies on
/// the target best, and the next best one that tops its surroundings and is at least 4 cells from it; finer than a cell
/// by the parabola through a top and its neighbors. Ties to the first by row. One or two; views must have cells of one
/// size. A view without cells scores 0.
std::vector<PlanarPose> best_shifts(const BirdsEye& source, const BirdsEyeImage& target, double yaw_rad,
                                    const Eigen::Vector2d& about_m, double window_m);

/// The same over some yaws: the best, and the next best that is at least 4 cells or 20 degrees from it.
std::vector<PlanarPose> best_planar_poses(const BirdsEye& source, const BirdsEyeImage& target,
                                          std::span<const double> yaws_rad, const Eigen::Vector2d& about_m,
                                          double window_m);

}  // namespace cmap
