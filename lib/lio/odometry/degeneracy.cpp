#include "odometry/degeneracy.hpp"

#include <Eigen/Eigenvalues>
#include <span>

namespace cmap {
namespace {

constexpr float kLeastCosine = 0.1f;

std::vector<Eigen::Vector3d> open_axes(std::span<const Eigen::Vector3f> directions, double least_points) {
  Eigen::Matrix3f sum = Eigen::Matrix3f::Zero();
  for (const Eigen::Vector3f& d : directions) sum += d * d.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(sum.cast<double>());
  std::vector<Eigen::Vector3d> open;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3f axis = axes.eigenvectors().col(i).cast<float>();
    double held = 0.0;
    for (const Eigen::Vector3f& d : directions) {
      const float cosine = d.dot(axis);
      if (std::abs(cosine) > kLeastCosine) held += static_cast<double>(cosine * cosine);
    }
    if (held < least_points) open.push_back(axes.eigenvectors().col(i));
  }
  return open;
}

Eigen::Matrix3d without(const std::vector<Eigen::Vector3d>& axes) {
  Eigen::Matrix3d projection = Eigen::Matrix3d::Identity();
  for (const Eigen::Vector3d& axis : axes) projection -= axis * axis.transpose();
  return projection;
}

}  // namespace

OpenDirections open_directions(const PlaneDirections& directions, double least_points) {
  return {open_axes(directions.normals, least_points), open_axes(directions.turns, least_points)};
}

void remove_open(PlaneSystem& system, const OpenDirections& open) {
  PoseMatrix projection = PoseMatrix::Zero();
  projection.block<3, 3>(part::kRotation, part::kRotation) = without(open.turns);
  projection.block<3, 3>(part::kPosition, part::kPosition) = without(open.shifts);
  system.information = projection * system.information * projection;
  system.gradient = projection * system.gradient;
}

}  // namespace cmap
