#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "refine/agreement.hpp"

namespace cmap {

/// The directions in which the camera may be moved: columns.
using Directions = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// The step that the normal equations ask for, along these directions; damping as Marquardt's.
Vector6d step_along(const Directions& along, const Sums& sums, double damping);

/// How well the calibration is known, as covariance. Noise averages out over so many views; what does not is that
/// views of unlike resolution and light are aligned to a part of a pixel, however many they are. The information holds
/// squared changes of gray, the sum of squared gradients turns them into pixels.
Matrix6d covariance_of(const Sums& sums, const Directions& along, double alignment_px);

/// The directions that are known well enough, turns and shifts measured by what they may be off; names of the others'
/// main axes.
Directions told_directions(const Matrix6d& covariance, const RefineOptions& refine,
                           std::vector<std::string>& free_axes);

}  // namespace cmap
