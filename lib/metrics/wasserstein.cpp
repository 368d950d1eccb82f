#include "cmap/metrics/wasserstein.hpp"

#include <algorithm>
#include <cmath>

#include "cmap/core/exact_sum.hpp"
#include "cmap/core/parallel.hpp"
#include "phase_fold.hpp"
#include "simd/kernels.hpp"
#include "voxel_moments.hpp"

namespace cmap {
namespace {

/// Points as offsets in their voxels.
struct PlaceSource {
  using Moments = VoxelMoments;

  PlaceSource(const PhasedFrame& frame, bool with_halves)
      : halves(with_halves), steps_of(frame.voxels().size_m()), m(frame.parts_per_axis()) {}

  bool counts(const IndexedMap&, std::size_t) const { return true; }
  struct Terms {
    OffsetLanes offsets;
    OffsetSteps at(std::size_t lane) const { return {offsets.x[lane], offsets.y[lane], offsets.z[lane]}; }
  };
  Terms terms(const IndexedMap& map, std::size_t block, const PartGrid& grid, const GridPlaces& places) const {
    Terms terms;
    metric_kernels().offsets(grid, 1.0 / steps_of.step_m(), map.index.points.blocks[block], places, terms.offsets);
    return terms;
  }
  void to_frame(Moments& moments, const VoxelKey& voxel) const { moments.move(steps_of.corner(voxel)); }

  /// Of a phase's voxel, before which none of its points lies: offsets are rounded.
  Corner corner(int phase, const VoxelKey& voxel) const {
    constexpr std::int64_t kMargin = 64;
    Corner at = steps_of.corner(voxel);
    const std::int64_t voxel_steps = steps_of.steps_per_voxel();
    const std::array<int, 3> shift{phase / (m * m), phase / m % m, phase % m};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (shift[axis] > 0) at[axis] -= voxel_steps * shift[axis] / m + kMargin;
    }
    return at;
  }

  bool halves;
  VoxelSteps steps_of;
  int m;
};

/// Takes the voxels of one task.
struct PlaceUse {
  const VoxelFrame* voxels;
  const PlaceSource* source;
  std::uint64_t min_points;
  VoxelWasserstein found;

  void voxel(int phase, const VoxelKey& key, const PhaseVoxel<VoxelMoments>& sums) {
    if (sums.reference.n() < min_points || sums.estimate.n() < min_points) return;
    const Corner corner = source->corner(phase, key);
    const GaussianPair pair{voxels->index(key), gaussian(sums.reference, corner), gaussian(sums.estimate, corner)};
    found.by_phase[static_cast<std::size_t>(phase)].push_back(
        {pair.index, wasserstein_distance(pair.reference, pair.estimate)});
    if (phase == 0) found.gaussians.push_back(pair);
  }
  void halves(const VoxelKey& key, const VoxelMoments& one, const VoxelMoments& other) {
    if (one.n() < min_points || other.n() < min_points) return;
    const Corner corner = source->corner(0, key);
    found.of_halves.push_back(wasserstein_distance(gaussian(one, corner), gaussian(other, corner)));
  }
  Gaussian gaussian(const VoxelMoments& sums, const Corner& corner) const {
    return sums.gaussian(source->steps_of.step_m(), corner);
  }
};

/// Of a symmetric matrix: its cofactors.
Eigen::Matrix3d cofactors(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d c;
  c(0, 0) = m(1, 1) * m(2, 2) - m(1, 2) * m(1, 2);
  c(1, 1) = m(0, 0) * m(2, 2) - m(0, 2) * m(0, 2);
  c(2, 2) = m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1);
  c(0, 1) = c(1, 0) = m(0, 2) * m(1, 2) - m(0, 1) * m(2, 2);
  c(0, 2) = c(2, 0) = m(0, 1) * m(1, 2) - m(0, 2) * m(1, 1);
  c(1, 2) = c(2, 1) = m(0, 1) * m(0, 2) - m(0, 0) * m(1, 2);
  return c;
}

/// Of a covariance, by its Schur complement about the largest variance: what is small keeps its digits. Noise below 0
/// is 0.
double determinant(const Eigen::Matrix3d& m) {
  Eigen::Index p = 0;
  const double pivot = m.diagonal().maxCoeff(&p);
  if (!(pivot > 0.0)) return 0.0;
  const Eigen::Index i = (p + 1) % 3, k = (p + 2) % 3;
  const double ii = m(i, i) - m(i, p) * m(i, p) / pivot, kk = m(k, k) - m(k, p) * m(k, p) / pivot;
  const double ik = m(i, k) - m(i, p) * m(k, p) / pivot;
  return std::max(0.0, pivot * (std::max(0.0, ii) * std::max(0.0, kk) - ik * ik));
}

/// tr (A^1/2 B A^1/2)^1/2 of two covariances: the sum r of the roots of the three eigenvalues of A B, from their sums
/// of products e1, e2, e3, as r^2 = e1 + 2 q and q^2 = e2 + 2 sqrt(e3) r, q being the sum of the products of two roots.
/// Each of the e is a product of what A and B have, so that flat ones lose no digits: a cofactor that should be 0 is
/// noise in both. Newton's method from above: r <= sqrt(3 e1), and r - sqrt(e1 + 2 q(r)) is convex.
double trace_of_root(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const Eigen::Matrix3d cofactors_a = cofactors(a), cofactors_b = cofactors(b);
  const double e1 = std::max(0.0, a.cwiseProduct(b).sum());
  const double e2 = std::max(0.0, cofactors_a.cwiseProduct(cofactors_b).sum());
  if (e1 == 0.0) return 0.0;
  const double most = std::sqrt(3.0 * e1);
  // 3 e1 e3 <= e2^2, which noise may not break.
  const double root_e3 = std::min(std::sqrt(determinant(a) * determinant(b)), e2 / most);
  double r = most;
  for (int step = 0; step < kFixedPointSteps; ++step) r = std::sqrt(e1 + 2.0 * std::sqrt(e2 + 2.0 * root_e3 * r));
  for (int step = 0; step < kNewtonSteps; ++step) {
    const double q = std::sqrt(e2 + 2.0 * root_e3 * r);
    const double next = std::sqrt(e1 + 2.0 * q), product = q * next;  // at least 9 root_e3
    if (product > 0.0) r += (next - r) * product / (product - root_e3);
  }
  return r;
}

}  // namespace

VoxelWasserstein voxel_wasserstein(const MapPair& pair, const PhaseOptions& options) {
  const PhasedFrame frame(united(pair.reference.index.bounds(), pair.estimate.index.bounds()), options.voxel_m,
                          options.parts_per_axis);
  const PlaceSource source(frame, options.halves);
  VoxelWasserstein all;
  all.by_phase.resize(static_cast<std::size_t>(frame.n_phases()));
  const PlaceUse prototype{&frame.voxels(), &source, std::max<std::uint64_t>(options.min_points, 2), all};
  for (const PlaceUse& use : PhaseFold<PlaceSource, PlaceUse>(maps_of(pair), frame, source).run(prototype)) {
    std::ranges::copy(use.found.gaussians, std::back_inserter(all.gaussians));
    std::ranges::copy(use.found.of_halves, std::back_inserter(all.of_halves));
    for (std::size_t phase = 0; phase < all.by_phase.size(); ++phase) {
      std::ranges::copy(use.found.by_phase[phase], std::back_inserter(all.by_phase[phase]));
    }
  }
  std::ranges::sort(all.gaussians, {}, &GaussianPair::index);
  for (auto& voxels : all.by_phase) {
    std::ranges::sort(voxels, [](const VoxelDistance& a, const VoxelDistance& b) {
      if (a.index[0] != b.index[0]) return a.index[0] < b.index[0];
      return a.index[1] != b.index[1] ? a.index[1] < b.index[1] : a.index[2] < b.index[2];
    });
  }
  return all;
}

std::vector<GaussianPair> gaussian_pairs(const MapPair& pair, double voxel_m, std::uint64_t min_points) {
  return voxel_wasserstein(pair, {.voxel_m = voxel_m, .min_points = min_points}).gaussians;
}

double wasserstein_distance(const Gaussian& a, const Gaussian& b) {
  const Eigen::Matrix3d cov_a = a.scatter * (1.0 / static_cast<double>(a.n - 1));
  const Eigen::Matrix3d cov_b = b.scatter * (1.0 / static_cast<double>(b.n - 1));
  const double traces = cov_a.trace() + cov_b.trace();
  const double sq = (a.mean - b.mean).squaredNorm() + traces - 2.0 * trace_of_root(cov_a, cov_b);
  return sq < 1e-12 * traces || sq <= 0.0 ? 0.0 : std::sqrt(sq);
}

double mean_distance(std::span<const VoxelDistance> voxels) {
  ExactSum sum;
  for (const VoxelDistance& voxel : voxels) sum.add(voxel.distance_m);
  return sum.value() / static_cast<double>(voxels.size());
}

}  // namespace cmap
