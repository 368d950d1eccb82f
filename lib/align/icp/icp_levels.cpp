#include "icp/icp_levels.hpp"

#include <cmath>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

/// A start that differs from a rigid motion by no more than its digits is one.
double scale_of_start(const Similarity& start, const Eigen::Matrix4d& T_initial) {
  constexpr double kDigits = 1e-6;
  const Eigen::Matrix3d linear = T_initial.topLeftCorner<3, 3>() / start.scale;
  const double rounding = 3.0 * (linear - start.rotation).cwiseAbs().maxCoeff() + kDigits;
  return std::abs(start.scale - 1.0) <= rounding ? 1.0 : start.scale;
}

}  // namespace

LevelRun run_level(LevelMatches& level, const NextTransform& next_from, const Similarity& start,
                   const IcpOptions& options) {
  const IcpLevel& settings = level.settings;
  const double unit_m = settings.voxel_m > 0.0 ? settings.voxel_m : settings.max_distance_m / 4.0;
  const StepLimits limits{options.min_rotation_rad, options.min_translation_voxels * unit_m, options.min_scale};
  LevelRun run{start};
  for (; run.iterations < settings.max_iterations && !run.converged; ++run.iterations) {
    level.field = level.source.nearest(level.target.index, run.local);
    const Similarity next = next_from(run.local);
    run.converged = limits.hold(run.local, next, level.source.center());
    run.local = next;
  }
  return run;
}

ThinnedSource::ThinnedSource(const PointCloud& source, double voxel_m, std::size_t most_points)
    : all(sort_points(thinned_to(source, voxel_m))) {
  if (most_points == 0 || all.size <= most_points) return;
  chosen = every_few(all.size, most_points);
}

LevelMatches::LevelMatches(const PointCloud& source_cloud, const PointCloud& target_cloud, double scale,
                           const IcpLevel& level, int neighbors)
    : settings(level),
      thinned(source_cloud, level.voxel_m / scale, level.most_points),
      source(thinned.chosen.empty() ? thinned.all : chosen_points(thinned.all, thinned.chosen)),
      target(thinned_target(target_cloud, level.voxel_m), static_cast<std::size_t>(neighbors)) {}

SourceSurface::SourceSurface(const LevelMatches& level, int neighbors)
    : index_(level.thinned.all), surface_(index_, static_cast<std::size_t>(neighbors)), chosen_(level.thinned.chosen) {
  if (chosen_.empty()) {
    surface_.fit_all();
  } else {
    surface_.fit(chosen_);
  }
}

Alignment iterate_levels(const PointCloud& source, const PointCloud& target, const Eigen::Matrix4d& T_initial,
                         const IcpOptions& options, const std::function<NextTransform(LevelMatches&)>& metric) {
  check_options(options);
  Alignment result;
  Similarity T = similarity_from(T_initial);
  T.scale = scale_of_start(T, T_initial);
  for (std::size_t i = 0; i < options.levels.size(); ++i) {
    const IcpLevel& settings = options.levels[i];
    LevelMatches level(source, target, T.scale, settings, options.neighbors);
    const LevelRun run = run_level(level, metric(level), local_transform(T, source.origin, target.origin), options);
    result.iterations += run.iterations;
    result.converged = run.converged;
    T = world_transform(run.local, source.origin, target.origin);
    if (i + 1 == options.levels.size()) {
      result.voxel_m = settings.voxel_m;
      result.max_distance_m = settings.max_distance_m;
      assess(level.source, level.target, run.local, settings.max_distance_m, options.with_scale, result);
    }
  }
  result.T_dst_src = T.matrix();
  result.scale = T.scale;
  tell_convergence(result);
  return result;
}

MatchedPoints matched_points(const LevelMatches& level, const Similarity& local, std::size_t slot) {
  const std::uint32_t target_slot = level.field.slot[slot];
  return {MovingSource::moved(local, level.source.points(), slot),
          level.target.index.points.offset(target_slot).cast<double>(), target_slot,
          std::sqrt(level.field.sq_dist[slot])};
}

double lever_m(const NormalEquations& equations) {
  const double lever_m = std::sqrt(equations.H.topLeftCorner<3, 3>().trace() / equations.H.block<3, 3>(3, 3).trace());
  if (!(lever_m > 0.0)) throw UnsupportedError("the matched points have no surface: they coincide or are collinear");
  return lever_m;
}

}  // namespace cmap
