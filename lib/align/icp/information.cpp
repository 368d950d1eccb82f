#include "icp/information.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "direction_text.hpp"

namespace cmap {
namespace {

/// Eigenvalues below this share of the largest are rounding noise of normals.
constexpr double kUndetermined = 1e-9;

using Jacobian = Eigen::Matrix<double, 3, 7>;

/// Derivative of a moved point by the step's parameters.
Jacobian jacobian(const Eigen::Vector3d& arm) {
  Jacobian J;
  J << 0.0, arm.z(), -arm.y(), 1, 0, 0, arm.x(),  //
      -arm.z(), 0.0, arm.x(), 0, 1, 0, arm.y(),   //
      arm.y(), -arm.x(), 0.0, 0, 0, 1, arm.z();
  return J;
}

/// Turns and scales measured by what they move at the end of the lever.
Vector7d per_meter(double lever_m) {
  Vector7d factors = Vector7d::Ones();
  factors.head<3>().setConstant(1.0 / lever_m);
  factors[6] = 1.0 / lever_m;
  return factors;
}

using Eigensystem = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

Eigensystem decompose(const Matrix7d& H, bool with_scale, double lever_m) {
  const Vector7d factors = per_meter(lever_m);
  const Matrix7d scaled = factors.asDiagonal() * H * factors.asDiagonal();
  const Eigen::Index size = with_scale ? 7 : 6;
  return Eigensystem(scaled.topLeftCorner(size, size));
}

/// The smallest eigenvalue of a 3x3 block and its direction.
std::pair<double, Eigen::Vector3d> weakest_of(const Eigen::Matrix3d& block) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(block);
  return {eigen.eigenvalues()[0], eigen.eigenvectors().col(0)};
}

/// A pure translation, rotation or scaling that is as weak as the weakest mixture; else the mixture's largest part.
std::string name_weakest(const Matrix7d& H, const Eigensystem& eigen, double lever_m) {
  const double tolerance = 2.0 * std::max(eigen.eigenvalues()[0], 0.0) + kUndetermined * eigen.eigenvalues().maxCoeff();
  const auto [translation, along] = weakest_of(H.block<3, 3>(3, 3));
  if (translation <= tolerance) return "translation along " + direction_text(along);
  const auto [rotation, about] = weakest_of(H.topLeftCorner<3, 3>() / (lever_m * lever_m));
  if (rotation <= tolerance) return "rotation about " + direction_text(about);
  const Eigen::VectorXd v = eigen.eigenvectors().col(0);
  const double scale = v.size() == 7 ? std::abs(v[6]) : 0.0;
  const double turn = v.head<3>().norm(), shift = v.segment<3>(3).norm();
  if (scale >= std::max(turn, shift)) return "scale";
  if (turn >= shift) return "rotation about " + direction_text(v.head<3>());
  return "translation along " + direction_text(v.segment<3>(3));
}

}  // namespace

void NormalEquations::add_plane(const Eigen::Vector3d& arm, const Eigen::Vector3d& r, const Eigen::Vector3d& normal,
                                double weight) {
  Vector7d j;
  j << arm.cross(normal), normal, arm.dot(normal);
  H.noalias() += (weight * j) * j.transpose();
  g += (weight * r.dot(normal)) * j;
  ++n;
}

void NormalEquations::add(const Eigen::Vector3d& arm, const Eigen::Vector3d& r, const Eigen::Matrix3d& M,
                          double weight) {
  const Jacobian J = jacobian(arm);
  const Jacobian weighted = (weight * M) * J;
  H.noalias() += J.transpose() * weighted;
  g.noalias() += weighted.transpose() * r;
  ++n;
}

Vector7d solve_parameters(const NormalEquations& equations, bool with_scale, double lever_m) {
  const Eigensystem eigen = decompose(equations.H, with_scale, lever_m);
  const Vector7d factors = per_meter(lever_m);
  const Eigen::Index size = eigen.eigenvalues().size();
  const Eigen::VectorXd g = factors.head(size).cwiseProduct(equations.g.head(size));
  Vector7d x = Vector7d::Zero();
  for (Eigen::Index i = 0; i < size; ++i) {
    const double value = eigen.eigenvalues()[i];
    if (value > kUndetermined * eigen.eigenvalues()[size - 1]) {
      x.head(size) -= eigen.eigenvectors().col(i) * (eigen.eigenvectors().col(i).dot(g) / value);
    }
  }
  return x.cwiseProduct(factors);
}

Similarity solve_step(const NormalEquations& equations, bool with_scale, double lever_m, const Eigen::Vector3d& pivot) {
  const Vector7d x = solve_parameters(equations, with_scale, lever_m);
  Similarity step;
  step.scale = std::exp(x[6]);
  step.rotation = rotation_from(x.head<3>());
  step.translation = pivot + x.segment<3>(3) - step.linear() * pivot;
  return step;
}

Observability observability(const Matrix7d& H, bool with_scale, double lever_m) {
  const Eigensystem eigen = decompose(H, with_scale, lever_m);
  const double largest = eigen.eigenvalues().maxCoeff();
  Observability result;
  result.condition = largest > 0.0 ? std::max(0.0, eigen.eigenvalues()[0]) / largest : 0.0;
  result.weakest = name_weakest(H, eigen, lever_m);
  return result;
}

std::vector<WeakDirection> standard_errors(const Matrix7d& H, const Matrix7d& gradient, bool with_scale, double lever_m,
                                           double far_m) {
  const Eigensystem eigen = decompose(H, with_scale, lever_m);
  const double least = kUndetermined * std::max(eigen.eigenvalues().maxCoeff(), 1e-300);
  const Eigen::MatrixXd inverse = eigen.eigenvectors() *
                                  eigen.eigenvalues().cwiseMax(least).cwiseInverse().asDiagonal() *
                                  eigen.eigenvectors().transpose();
  const Vector7d factors = per_meter(lever_m);
  const Matrix7d scaled = factors.asDiagonal() * gradient * factors.asDiagonal();
  const Eigen::MatrixXd covariance = inverse * scaled.topLeftCorner(inverse.rows(), inverse.rows()) * inverse;
  std::vector<WeakDirection> errors;
  const auto add_block = [&](Eigen::Index first, const char* what, double factor) {
    const Eigen::Matrix3d block = covariance.block<3, 3>(first, first);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(block);
    for (Eigen::Index i = 0; i < 3; ++i) {
      errors.push_back({what + direction_text(axes.eigenvectors().col(i)),
                        factor * std::sqrt(std::max(0.0, axes.eigenvalues()[i]))});
    }
  };
  add_block(0, "rotation about ", far_m / lever_m);
  add_block(3, "translation along ", 1.0);
  if (with_scale) errors.push_back({"scale", far_m / lever_m * std::sqrt(covariance(6, 6))});
  std::stable_sort(errors.begin(), errors.end(), [](const WeakDirection& a, const WeakDirection& b) {
    return a.standard_error_m > b.standard_error_m;
  });
  return errors;
}

void tell_observability(const Observability& found, Alignment& result) {
  constexpr double kWeak = 1e-3;
  result.condition = found.condition;
  result.weakest = found.weakest;
  if (result.condition < kWeak) {
    result.warnings.push_back(
        fmt::format("{} is only weakly determined (condition {:.1e})", found.weakest, found.condition));
  }
}

void tell_convergence(Alignment& result) {
  if (!result.converged) result.warnings.push_back(fmt::format("not converged after {} iterations", result.iterations));
}

}  // namespace cmap
