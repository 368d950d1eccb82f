#include "cmap/metrics/wasserstein.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "cmap/core/exact_sum.hpp"
#include "cmap/core/parallel.hpp"
#include "voxel_moments.hpp"
#include "voxels.hpp"

namespace cmap {
namespace {

struct VoxelGaussian {
  VoxelIndex index;
  Gaussian gaussian;
};

/// The map's voxels with at least min_points points, ordered by index.
std::vector<VoxelGaussian> voxel_gaussians(const PointBlocks& points, const VoxelFrame& frame, const VoxelSteps& steps,
                                           std::uint64_t min_points) {
  const auto add = [&](VoxelMoments& moments, std::size_t, const Eigen::Vector3d& world, const VoxelKey& key) {
    moments.add(steps.offset(world, key));
  };
  const auto finish = [&](const VoxelKey& key, const VoxelMoments& moments) -> std::optional<VoxelGaussian> {
    if (moments.n() < min_points) return std::nullopt;
    return VoxelGaussian{frame.index(key), moments.gaussian(steps.step_m())};
  };
  std::vector<VoxelGaussian> voxels = collect_voxels<VoxelMoments>(points, frame, add, finish);
  std::ranges::sort(voxels, {}, &VoxelGaussian::index);
  return voxels;
}

/// Symmetric square root of a covariance.
Eigen::Matrix3d root(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

}  // namespace

std::vector<GaussianPair> gaussian_pairs(const MapPair& pair, double voxel_m, std::uint64_t min_points) {
  const VoxelFrame frame(united(pair.reference.index.bounds(), pair.estimate.index.bounds()), voxel_m);
  const std::uint64_t enough = std::max<std::uint64_t>(min_points, 2);
  const VoxelSteps steps(frame, voxel_m);
  const auto in_reference = voxel_gaussians(pair.reference.index.points, frame, steps, enough);
  const auto in_estimate = voxel_gaussians(pair.estimate.index.points, frame, steps, enough);

  std::vector<GaussianPair> pairs;
  auto other = in_estimate.begin();
  for (const auto& [index, gaussian] : in_reference) {
    while (other != in_estimate.end() && other->index < index) ++other;
    if (other != in_estimate.end() && other->index == index) pairs.push_back({index, gaussian, other->gaussian});
  }
  return pairs;
}

double wasserstein_distance(const Gaussian& a, const Gaussian& b) {
  const Eigen::Matrix3d cov_a = a.covariance();
  const Eigen::Matrix3d cov_b = b.covariance();
  // tr (S1^1/2 S2 S1^1/2)^1/2 is the sum of the singular values of S1^1/2 S2^1/2, which keeps flat voxels' digits.
  const double root_trace = (root(cov_a) * root(cov_b)).eval().jacobiSvd().singularValues().sum();
  const double traces = cov_a.trace() + cov_b.trace();
  const double sq = (a.mean - b.mean).squaredNorm() + traces - 2.0 * root_trace;
  return sq < 1e-12 * traces || sq <= 0.0 ? 0.0 : std::sqrt(sq);
}

std::vector<VoxelDistance> wasserstein_distances(std::span<const GaussianPair> pairs) {
  constexpr std::size_t kPairChunk = 256;
  std::vector<VoxelDistance> distances(pairs.size());
  parallel_chunks(pairs.size(), kPairChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      distances[i] = {pairs[i].index, wasserstein_distance(pairs[i].reference, pairs[i].estimate)};
    }
  });
  return distances;
}

double mean_distance(std::span<const VoxelDistance> voxels) {
  ExactSum sum;
  for (const VoxelDistance& voxel : voxels) sum.add(voxel.distance_m);
  return sum.value() / static_cast<double>(voxels.size());
}

}  // namespace cmap
