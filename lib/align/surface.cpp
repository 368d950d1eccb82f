#include "align/surface.hpp"

#include <Eigen/Eigenvalues>

#include "cmap/core/parallel.hpp"
#include "cmap/spatial/k_nearest.hpp"

namespace cmap {
namespace {

constexpr std::size_t kPointChunk = 1024;

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

Surface surface_of(const Bvh& cloud, std::size_t k) {
  const Array<std::uint32_t> neighbors = find_k_nearest(cloud, cloud.points, k);
  Surface surface{Array<Eigen::Vector3f>(cloud.points.size), Array<float>(cloud.points.size)};
  parallel_chunks(cloud.points.size, kPointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const LocalPlane plane = plane_through(cloud.points, &neighbors[slot * k], k);
      surface.normals[slot] = plane.normal;
      surface.tilt_variance[slot] = plane.tilt_variance;
    }
  });
  return surface;
}

}  // namespace cmap
