#include "cmap/metrics/wasserstein.hpp"

#include <algorithm>
#include <cmath>

#include "cmap/core/exact_sum.hpp"
#include "cmap/core/parallel.hpp"
#include "phase_fold.hpp"
#include "voxel_moments.hpp"

namespace cmap {
namespace {

/// Points as offsets in their voxels.
struct PlaceSource {
  using Moments = VoxelMoments;

  PlaceSource(const PhasedFrame& frame, bool with_halves)
      : halves(with_halves), steps_of(frame.voxels(), frame.voxels().size_m()) {
    // A phase's voxel begins with part m - k of the voxel before its own, or a little earlier, as offsets are rounded.
    constexpr double kMargin = 64.0;
    const int m = frame.parts_per_axis();
    const double voxel = frame.voxels().size_m() / steps_of.step_m();
    for (int k = 1; k < m; ++k) {
      const double begin = std::floor(voxel * (m - k) / m - kMargin);
      corner_steps[static_cast<std::size_t>(k)] = {static_cast<std::int64_t>(std::round(voxel) - begin),
                                                   -static_cast<std::int64_t>(begin)};
    }
  }

  bool counts(const IndexedMap&, std::size_t) const { return true; }
  void add(Moments& moments, const IndexedMap& map, std::size_t slot, const VoxelKey& voxel) const {
    moments.add(steps_of.offset(map.index.points.world(slot), voxel));
  }
  static constexpr bool kHasCorners = true;
  void merge(Moments& into, const Moments& part, int axis, int shift, int after) const {
    std::array<std::int64_t, 3> by{};
    by[static_cast<std::size_t>(axis)] = corner_steps[static_cast<std::size_t>(shift)][static_cast<std::size_t>(after)];
    into.add_moved(part, by);
  }

  bool halves;
  VoxelSteps steps_of;
  /// By shift: what offsets in the voxel of a phase's own index, and in the one before it, have to move.
  std::array<std::array<std::int64_t, 2>, 3> corner_steps{};
};

/// Takes the voxels of one task.
struct PlaceUse {
  std::uint64_t min_points;
  double step_m;
  VoxelWasserstein found;

  void voxel(int phase, const VoxelIndex& index, const PhaseVoxel<VoxelMoments>& sums) {
    if (sums.reference.n() < min_points || sums.estimate.n() < min_points) return;
    const GaussianPair pair{index, sums.reference.gaussian(step_m), sums.estimate.gaussian(step_m)};
    found.by_phase[static_cast<std::size_t>(phase)].push_back(
        {index, wasserstein_distance(pair.reference, pair.estimate)});
    if (phase == 0) found.gaussians.push_back(pair);
  }
  void halves(const VoxelMoments& one, const VoxelMoments& other) {
    if (one.n() < min_points || other.n() < min_points) return;
    found.of_halves.push_back(wasserstein_distance(one.gaussian(step_m), other.gaussian(step_m)));
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
  constexpr int kMostSteps = 8;
  constexpr double kNearEnough = 1e-9;  // each step squares what is missing
  const Eigen::Matrix3d cofactors_a = cofactors(a), cofactors_b = cofactors(b);
  const double e1 = std::max(0.0, a.cwiseProduct(b).sum());
  const double e2 = std::max(0.0, cofactors_a.cwiseProduct(cofactors_b).sum());
  if (e1 == 0.0) return 0.0;
  const double most = std::sqrt(3.0 * e1);
  // 3 e1 e3 <= e2^2, which noise may not break.
  const double root_e3 = std::min(std::sqrt(determinant(a) * determinant(b)), e2 / most);
  double r = std::sqrt(e1 + 2.0 * std::sqrt(e2 + 2.0 * root_e3 * most));
  for (int step = 0; step < kMostSteps; ++step) {
    const double q = std::sqrt(e2 + 2.0 * root_e3 * r);
    const double next = std::sqrt(e1 + 2.0 * q);
    const double slope = q > 0.0 ? root_e3 / (q * next) : 0.0;  // at most 1/9
    const double change = (next - r) / (1.0 - slope);
    r += change;
    if (std::abs(change) <= kNearEnough * r) break;
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
  const PlaceUse prototype{std::max<std::uint64_t>(options.min_points, 2), source.steps_of.step_m(), all};
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
