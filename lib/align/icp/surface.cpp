#include "icp/surface.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "cmap/core/parallel.hpp"
#include "cmap/spatial/k_nearest.hpp"

namespace cmap {
namespace {

constexpr std::size_t kSurfaceChunk = 1024;

/// Neighborhoods whose variance across is below this share of that along are lines.
constexpr double kLine = 0.02;

struct LocalPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float tilt_variance = 0.0f;
};

LocalPlane plane_through(const PointBlocks& points, const std::uint32_t* neighbors, std::size_t k) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  std::size_t n = 0;
  for (; n < k && neighbors[n] != kNoNeighbor; ++n) mean += points.offset(neighbors[n]).cast<double>();
  mean /= static_cast<double>(n);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d d = points.offset(neighbors[i]).cast<double>() - mean;
    scatter += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(scatter);
  const Eigen::Vector3d spread = eigen.eigenvalues().cwiseMax(0.0);
  if (!(spread[1] > kLine * spread[2])) return {};
  return {eigen.eigenvectors().col(0).cast<float>(),
          static_cast<float>(spread[0] / (spread[1] * static_cast<double>(n)))};
}

}  // namespace

Surface::Surface(const Bvh& cloud, std::size_t k)
    : cloud_(cloud),
      k_(k),
      normals_(cloud.points.size),
      tilt_variance_(cloud.points.size),
      is_known_(cloud.points.size, std::uint8_t{0}) {}

void Surface::fit(const Array<std::uint32_t>& slots) {
  Array<std::uint32_t> missing;
  for (const std::uint32_t slot : slots) {
    if (is_known_[slot]) continue;
    is_known_[slot] = 1;
    missing.push_back(slot);
  }
  if (missing.empty()) return;
  std::sort(missing.begin(), missing.end());  // neighbors in a row are found faster
  const Array<std::uint32_t> neighbors = find_k_nearest(cloud_, chosen_points(cloud_.points, missing), k_);
  parallel_chunks(missing.size(), kSurfaceChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LocalPlane plane = plane_through(cloud_.points, &neighbors[i * k_], k_);
      normals_[missing[i]] = plane.normal;
      tilt_variance_[missing[i]] = plane.tilt_variance;
    }
  });
}

void Surface::fit_all() {
  Array<std::uint32_t> all(cloud_.points.size);
  std::iota(all.begin(), all.end(), 0u);
  fit(all);
}

}  // namespace cmap
