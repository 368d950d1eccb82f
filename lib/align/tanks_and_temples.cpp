#include "cmap/align/tanks_and_temples.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "icp/registration_cloud.hpp"

namespace cmap {
namespace {

constexpr int kIterations = 30;
constexpr double kSmallestChange = 1e-6;  ///< of the share of matched points

struct Stage {
  double voxel_m;  ///< 0: every k-th point instead
  double max_distance_m;
};

PointCloud every_kth(const PointCloud& cloud, std::size_t most_points) {
  if (cloud.size() <= most_points) return cloud;
  const double ratio = static_cast<double>(cloud.size()) / static_cast<double>(most_points);
  const auto k = static_cast<std::size_t>(std::nearbyint(ratio));
  Array<std::uint8_t> keep(cloud.size(), 0);
  for (std::size_t i = 0; i < cloud.size(); i += k) keep[i] = 1;
  return select(cloud, keep);
}

PointCloud cropped(const PointCloud& cloud, const TanksAndTemplesOptions& options, const char* which) {
  PointCloud inside = options.crop ? crop(cloud, *options.crop) : cloud;
  if (inside.positions.empty()) throw UnsupportedError(fmt::format("no point of the {} is inside the crop", which));
  return inside;
}

/// Plain point-to-point ICP with scale from where the source is.
Similarity refine(MovingSource& source, const Bvh& target, double max_distance_m, Alignment& result) {
  Similarity local = local_transform({}, source.points().origin, target.points.origin);
  double matched_before = -1.0;
  const double sq_max = max_distance_m * max_distance_m;
  result.converged = false;
  for (int i = 0; i < kIterations && !result.converged; ++i) {
    const NearestField field = source.nearest(target, local);
    const PairMoments moments = pair_moments(source.size(), [&](std::size_t slot) {
      return WeightedPair{source.points().offset(slot).cast<double>(),
                          target.points.offset(field.slot[slot]).cast<double>(),
                          field.sq_dist[slot] < sq_max ? 1.0 : 0.0};
    });
    if (moments.n < 3) fail_no_overlap(moments.n, max_distance_m);
    const double matched = static_cast<double>(moments.n) / static_cast<double>(source.size());
    result.converged = std::abs(matched - matched_before) < kSmallestChange;
    matched_before = matched;
    local = fit_similarity(moments, ScaleModel::free());
    ++result.iterations;
  }
  return world_transform(local, source.points().origin, target.points.origin);
}

Similarity run_stage(const PointCloud& source, const PointCloud& target, const Similarity& T, const Stage& stage,
                     const TanksAndTemplesOptions& options, Alignment& result) {
  const auto reduced = [&](const PointCloud& cloud) {
    return stage.voxel_m > 0.0 ? thinned_to(cloud, stage.voxel_m) : every_kth(cloud, options.most_points);
  };
  MovingSource moving(reduced(cropped(transformed(source, T.matrix()), options, "source")));
  const Bvh index(sort_points(reduced(cropped(target, options, "target"))));
  return refine(moving, index, stage.max_distance_m, result) * T;
}

/// Share of points nearer than tau, and the sum of those squared distances.
double share_nearer(const NearestField& field, double tau_m, double& sum_sq) {
  std::size_t n = 0;
  for (const double sq_dist : field.sq_dist) {
    if (!(sq_dist < tau_m * tau_m)) continue;
    ++n;
    sum_sq += sq_dist;
  }
  return static_cast<double>(n) / static_cast<double>(field.sq_dist.size());
}

void score(const PointCloud& source, const PointCloud& target, const Similarity& T,
           const TanksAndTemplesOptions& options, TanksAndTemplesResult& result) {
  const double voxel_m = options.tau_m / 2.0;
  const Bvh s(sort_points(thinned_to(cropped(transformed(source, T.matrix()), options, "source"), voxel_m)));
  const Bvh t(sort_points(thinned_to(cropped(target, options, "target"), voxel_m)));
  double sum_sq = 0.0, unused = 0.0;
  result.precision = share_nearer(find_nearest(t, s.points), options.tau_m, sum_sq);
  result.recall = share_nearer(find_nearest(s, t.points), options.tau_m, unused);
  const double both = result.precision + result.recall;
  result.f_score = both > 0.0 ? 2.0 * result.precision * result.recall / both : 0.0;
  result.n_source = result.alignment.n_source = s.points.size;
  result.n_target = result.alignment.n_target = t.points.size;
  result.alignment.overlap = result.precision;
  const double n_matches = std::round(result.precision * static_cast<double>(s.points.size));
  result.alignment.n_matches = static_cast<std::size_t>(n_matches);
  result.alignment.rmse_m = n_matches > 0.0 ? std::sqrt(sum_sq / n_matches) : 0.0;
}

}  // namespace

TanksAndTemplesResult tanks_and_temples(const PointCloud& source, const PointCloud& target,
                                        const Eigen::Matrix4d& T_initial, const TanksAndTemplesOptions& options,
                                        const Execution& execution) {
  const ExecutionScope scope(execution);
  const double tau_m = options.tau_m;
  if (!(tau_m > 0.0) || !std::isfinite(tau_m)) throw UsageError(fmt::format("tau_m is {:g}: above 0 is needed", tau_m));
  if (options.most_points == 0) throw UsageError("most_points is 0: at least 1 is needed");
  Similarity T = similarity_from(T_initial);
  TanksAndTemplesResult result;
  Alignment& alignment = result.alignment;
  alignment.method = "tanksandtemples";
  alignment.converged = !options.refine;
  if (options.refine) {
    for (const Stage& stage : {Stage{tau_m, 80.0 * tau_m}, Stage{tau_m / 2.0, 20.0 * tau_m}, Stage{0.0, 2.0 * tau_m}}) {
      T = run_stage(source, target, T, stage, options, alignment);
    }
  }
  tell_convergence(alignment);
  score(source, target, T, options, result);
  if (options.refine) {
    // How well the geometry holds the result, with the matches that count.
    MovingSource moving(thinned_to(cropped(transformed(source, T.matrix()), options, "source"), tau_m / 2.0));
    RegistrationTarget surface(thinned_to(cropped(target, options, "target"), tau_m / 2.0), 10);
    assess(moving, surface, local_transform({}, moving.points().origin, surface.index.points.origin), tau_m, true,
           alignment);
  }
  alignment.T_dst_src = T.matrix();
  alignment.scale = T.scale;
  alignment.voxel_m = tau_m / 2.0;
  alignment.max_distance_m = tau_m;
  return result;
}

}  // namespace cmap
