#include "icp_levels.hpp"

#include <cmath>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

/// Iterates one level from a local transform; returns the last one.
Similarity run_level(LevelMatches& level, const NextTransform& next_from, Similarity local, const IcpOptions& options,
                     Alignment& result) {
  const IcpLevel& settings = level.settings;
  const double unit_m = settings.voxel_m > 0.0 ? settings.voxel_m : settings.max_distance_m / 4.0;
  const StepLimits limits{options.min_rotation_rad, options.min_translation_voxels * unit_m, options.min_scale};
  result.converged = false;
  for (int i = 0; i < settings.max_iterations && !result.converged; ++i) {
    level.field = level.source.nearest(level.target.index, local);
    const Similarity next = next_from(local);
    result.converged = limits.hold(local, next, level.source.center());
    local = next;
    ++result.iterations;
  }
  return local;
}

}  // namespace

LevelMatches::LevelMatches(const PointCloud& source_cloud, const PointCloud& target_cloud, double scale,
                           const IcpLevel& level, int neighbors)
    : settings(level),
      source(thinned_to(source_cloud, level.voxel_m / scale)),
      target(thinned_target(target_cloud, level.voxel_m), static_cast<std::size_t>(neighbors)) {}

SourceSurface::SourceSurface(const MovingSource& source, int neighbors)
    : index(source.points()), surface(index, static_cast<std::size_t>(neighbors)) {
  surface.fit_all();
}

Alignment iterate_levels(const PointCloud& source, const PointCloud& target, const Eigen::Matrix4d& T_initial,
                         const IcpOptions& options, const std::function<NextTransform(LevelMatches&)>& metric) {
  check_options(options);
  Alignment result;
  Similarity T = similarity_from(T_initial);
  for (std::size_t i = 0; i < options.levels.size(); ++i) {
    const IcpLevel& settings = options.levels[i];
    LevelMatches level(source, target, T.scale, settings, options.neighbors);
    const Similarity start = local_transform(T, source.origin, target.origin);
    const Similarity local = run_level(level, metric(level), start, options, result);
    T = world_transform(local, source.origin, target.origin);
    if (i + 1 == options.levels.size()) {
      result.voxel_m = settings.voxel_m;
      result.max_distance_m = settings.max_distance_m;
      assess(level.source, level.target, local, settings.max_distance_m, options.with_scale, result);
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
