#include "cmap/geometry/similarity.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "cmap/core/error.hpp"

namespace cmap {

Eigen::Matrix4d Similarity::matrix() const {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = linear();
  T.topRightCorner<3, 1>() = translation;
  return T;
}

Similarity Similarity::inverse() const {
  Similarity inverse;
  inverse.scale = 1.0 / scale;
  inverse.rotation = rotation.transpose();
  inverse.translation = -inverse.scale * (inverse.rotation * translation);
  return inverse;
}

Similarity Similarity::operator*(const Similarity& b) const {
  return {scale * b.scale, rotation * b.rotation, *this * b.translation};
}

Similarity similarity_from(const Eigen::Matrix4d& matrix) {
  constexpr double kTolerance = 1e-3;
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const double scale = std::cbrt(linear.determinant());
  if (!matrix.allFinite() || !(scale > 0.0) || matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw UnsupportedError("the 4x4 matrix is no rotation times a positive scale with a translation");
  }
  const Eigen::Matrix3d rotation = nearest_rotation(linear / scale);
  const double deviation = (linear / scale - rotation).cwiseAbs().maxCoeff();
  if (!(deviation <= kTolerance)) {
    throw UnsupportedError(
        fmt::format("the linear part of the 4x4 matrix deviates by {:.3g} from a rotation times a "
                    "scale; {:g} accepted",
                    deviation, kTolerance));
  }
  return {scale, rotation, matrix.topRightCorner<3, 1>()};
}

double farthest_apart(const Similarity& a, const Similarity& b, std::span<const Eigen::Vector3d> points) {
  double farthest = 0.0;
  for (const Eigen::Vector3d& point : points) farthest = std::max(farthest, (a * point - b * point).norm());
  return farthest;
}

}  // namespace cmap
