#pragma once

#include <Eigen/Core>
#include <span>

#include "cmap/geometry/rotation.hpp"

namespace cmap {

/// Small changes of a similarity and their information: rotation, translation and log scale, in the order that the user
/// says.
using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

/// x_dst = scale rotation x_src + translation: a rigid motion where the scale is 1.
struct Similarity {
  double scale = 1.0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Matrix3d linear() const { return scale * rotation; }
  Eigen::Matrix4d matrix() const;
  Similarity inverse() const;

  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return scale * (rotation * x) + translation; }
  /// a * b applies b first.
  Similarity operator*(const Similarity& b) const;
};

/// The similarity that a homogeneous matrix stands for; its rotation is made orthonormal. Throws UnsupportedError where
/// the linear part deviates by more than 1e-3 from a rotation times a positive scale.
Similarity similarity_from(const Eigen::Matrix4d& matrix);

/// The farthest that two of them place one of the points apart.
double farthest_apart(const Similarity& a, const Similarity& b, std::span<const Eigen::Vector3d> points);

}  // namespace cmap
