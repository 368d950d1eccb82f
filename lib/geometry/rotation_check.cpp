#include "cmap/geometry/rotation_check.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <limits>

namespace cmap {

double deviation_from_rotation(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite() || !(matrix.determinant() > 0.0)) return std::numeric_limits<double>::infinity();
  return (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

}  // namespace cmap
