#pragma once

#include <Eigen/Core>

#include "cmap/core/rotation.hpp"

namespace cmap {

/// Written rotations may be this far from one (largest entry of R^T R - I) without a word.
inline constexpr double kRotationTolerance = 1e-3;

/// Largest entry of |R^T R - I|; infinite where det R <= 0 or an entry is not finite, as no rotation is meant then.
double deviation_from_rotation(const Eigen::Matrix3d& matrix);

}  // namespace cmap
