#include "global/main_axes.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace cmap {
namespace {

constexpr float kSameAxis = 0.978f;  ///< cosine of 12 degrees
constexpr float kDistinct = 0.707f;
constexpr std::size_t kMostNormals = 2000, kGuesses = 200, kAxes = 3;
constexpr int kRefinements = 3;

std::vector<Eigen::Vector3f> thinned(std::span<const Eigen::Vector3f> normals) {
  std::vector<Eigen::Vector3f> known;
  const std::size_t step = normals.size() / kMostNormals + 1;
  for (std::size_t i = 0; i < normals.size(); i += step) {
    if (normals[i].squaredNorm() > 0.5f) known.push_back(normals[i]);
  }
  return known;
}

std::size_t count_alike(const std::vector<Eigen::Vector3f>& normals, const Eigen::Vector3f& axis) {
  std::size_t n = 0;
  for (const Eigen::Vector3f& normal : normals) n += std::abs(normal.dot(axis)) > kSameAxis ? 1 : 0;
  return n;
}

Eigen::Vector3f refined(const std::vector<Eigen::Vector3f>& normals, Eigen::Vector3f axis) {
  for (int i = 0; i < kRefinements; ++i) {
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3f& normal : normals) {
      if (std::abs(normal.dot(axis)) <= kSameAxis) continue;
      const Eigen::Vector3d n = normal.cast<double>();
      scatter += n * n.transpose();
    }
    axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(2).cast<float>();
  }
  return axis;
}

}  // namespace

std::vector<MainAxis> main_axes(std::span<const Eigen::Vector3f> normals) {
  std::vector<Eigen::Vector3f> left = thinned(normals);
  const double n_all = static_cast<double>(left.size());
  std::vector<MainAxis> axes;
  while (axes.size() < kAxes && !left.empty()) {
    Eigen::Vector3f best = left[0];
    std::size_t most = 0;
    for (std::size_t i = 0; i < left.size(); i += left.size() / kGuesses + 1) {
      const std::size_t n = count_alike(left, left[i]);
      if (n > most) most = n, best = left[i];
    }
    const Eigen::Vector3f axis = refined(left, best);
    axes.push_back({axis.cast<double>(), static_cast<double>(count_alike(left, axis)) / n_all});
    std::erase_if(left, [&](const Eigen::Vector3f& normal) { return std::abs(normal.dot(axis)) > kDistinct; });
  }
  return axes;
}

}  // namespace cmap
