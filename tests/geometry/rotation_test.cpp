#include "cmap/geometry/rotation.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace cmap {
namespace rotation_test {

/// Rotations of all sizes: none, tiny, about where series end, large, and nearly half a turn.
std::vector<Eigen::Vector3d> rotations() {
  std::vector<Eigen::Vector3d> all;
  const Eigen::Vector3d axis = Eigen::Vector3d(0.36, -0.48, 0.8);
  for (const double angle : {0.0, 1e-12, 1e-5, 0.99e-4, 1.01e-4, 0.99e-3, 1.01e-3, 0.1, 1.0, 2.5, 3.1}) {
    all.emplace_back(angle * axis);
    all.emplace_back(0.0, 0.0, -angle);
  }
  return all;
}

/// Central differences of f: R^3 -> R^3.
template <class Function>
Eigen::Matrix3d derivative(Function&& f, double step = 1e-5) {
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(i);
    result.col(i) = (f(d) - f(-d)) / (2.0 * step);
  }
  return result;
}

// Differences are exact to step^2, 1e-10, times third derivatives; those of the logarithm grow toward half a turn.
constexpr double kDifferences = 1e-7;

TEST(Rotation, LogarithmInvertsTheExponential) {
  for (const Eigen::Vector3d& phi : rotations()) {
    const Eigen::Quaterniond q = rotation_exp(phi);
    EXPECT_NEAR((rotation_log(q) - phi).norm(), 0.0, 1e-14 + 1e-14 * phi.norm()) << phi.transpose();
    const Eigen::Quaterniond other_sign(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_NEAR((rotation_log(other_sign) - phi).norm(), 0.0, 1e-14 + 1e-14 * phi.norm()) << phi.transpose();
  }
}

TEST(Rotation, ExponentialIsTheMatrixOfAxisAndAngle) {
  for (const Eigen::Vector3d& phi : rotations()) {
    EXPECT_LT((rotation_exp(phi).toRotationMatrix() - rotation_from(phi)).norm(), 1e-14) << phi.transpose();
  }
}

TEST(Rotation, RightJacobianIsTheDerivativeOfTheExponential) {
  for (const Eigen::Vector3d& phi : rotations()) {
    const Eigen::Quaterniond back = rotation_exp(phi).conjugate();
    const Eigen::Matrix3d numeric =
        derivative([&](const Eigen::Vector3d& d) { return rotation_log(back * rotation_exp(phi + d)); });
    EXPECT_LT((right_jacobian(phi) - numeric).norm(), kDifferences) << phi.transpose();
  }
}

TEST(Rotation, InverseRightJacobianIsTheDerivativeOfTheLogarithm) {
  for (const Eigen::Vector3d& phi : rotations()) {
    const Eigen::Matrix3d numeric =
        derivative([&](const Eigen::Vector3d& d) { return rotation_log(rotation_exp(phi) * rotation_exp(d)); });
    EXPECT_LT((inverse_right_jacobian(phi) - numeric).norm(), kDifferences) << phi.transpose();
    EXPECT_LT((inverse_right_jacobian(phi) * right_jacobian(phi) - Eigen::Matrix3d::Identity()).norm(), 1e-9)
        << "the series end at 1e-6 of a squared angle: " << phi.transpose();
  }
}

TEST(Rotation, CrossMatrixIsTheCrossProduct) {
  const Eigen::Vector3d a(1.0, -2.0, 3.0), b(0.5, 4.0, -1.0);
  EXPECT_EQ(cross_matrix(a) * b, a.cross(b));
}

}  // namespace rotation_test
}  // namespace cmap
