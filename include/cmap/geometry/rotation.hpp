#pragma once

#include <Eigen/Core>

namespace cmap {

/// The rotation nearest to a matrix in the sense of least squares (its polar factor, determinant +1).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

}  // namespace cmap
