#include "cmap/geometry/rotation.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <limits>

namespace cmap {

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) signs.z() = -1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

double deviation_from_rotation(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite() || !(matrix.determinant() > 0.0)) return std::numeric_limits<double>::infinity();
  return (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

double rotation_angle_rad(const Eigen::Matrix3d& r) {
  const Eigen::Vector3d twice_sine(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
  return std::atan2(twice_sine.norm(), r.trace() - 1.0);
}

Eigen::Matrix3d rotation_from(const Eigen::Vector3d& axis_angle_rad) {
  const double angle = axis_angle_rad.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, axis_angle_rad / angle).toRotationMatrix();
}

}  // namespace cmap
