#include "refine/told_directions.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <numbers>

namespace cmap {

Vector6d step_along(const Directions& along, const Sums& sums, double damping) {
  Eigen::MatrixXd reduced = along.transpose() * sums.information * along;
  reduced.diagonal() *= 1.0 + damping;
  return along * reduced.ldlt().solve(along.transpose() * sums.right);
}

Matrix6d covariance_of(const Sums& sums, const Directions& along, double alignment_px) {
  const Eigen::MatrixXd reduced = along.transpose() * sums.information * along;
  const Eigen::MatrixXd inverse = reduced.ldlt().solve(Eigen::MatrixXd::Identity(along.cols(), along.cols()));
  return alignment_px * alignment_px * sums.sq_gradients * (along * inverse * along.transpose());
}

Directions told_directions(const Matrix6d& covariance, const RefineOptions& refine,
                           std::vector<std::string>& free_axes) {
  static constexpr const char* kNames[] = {"turn x", "turn y", "turn z", "shift x", "shift y", "shift z"};
  Vector6d unit;
  unit << Eigen::Vector3d::Constant(refine.largest_sigma_deg / (180.0 / std::numbers::pi)),
      Eigen::Vector3d::Constant(refine.largest_sigma_m);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> axes(unit.cwiseInverse().asDiagonal() * covariance *
                                                     unit.cwiseInverse().asDiagonal());
  Directions told(6, 0);
  for (int i = 0; i < 6; ++i) {
    const Vector6d axis = axes.eigenvectors().col(i);
    if (axes.eigenvalues()[i] <= 1.0) {
      told.conservativeResize(6, told.cols() + 1);
      told.rightCols<1>() = unit.cwiseProduct(axis);
    } else {
      Eigen::Index most = 0;
      axis.cwiseAbs().maxCoeff(&most);
      free_axes.emplace_back(kNames[most]);
    }
  }
  return told;
}

}  // namespace cmap
