#include "cmap/align/icp.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <optional>

#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "registration_cloud.hpp"
#include "require.hpp"

namespace cmap {
namespace {

constexpr std::size_t kPointChunk = 1024;
constexpr double kPlaneThickness = 1e-3;  ///< variance across a plane over that along it (Segal et al.)

constexpr std::array<const char*, 3> kMetricNames{"icp", "plane", "gicp"};

/// What an iteration sees: one level's clouds and the matches at the present transform.
class Level {
 public:
  Level(const PointCloud& source, const PointCloud& target, double scale, const IcpLevel& level,
        const IcpOptions& options)
      : level_(level),
        options_(options),
        source_(thinned_to(source, level.voxel_m / scale)),
        target_(thinned_target(target, level.voxel_m), static_cast<std::size_t>(options.neighbors)) {
    if (options.metric == IcpMetric::kGicp) {
      source_index_.emplace(source_.points());
      source_surface_.emplace(*source_index_, static_cast<std::size_t>(options.neighbors));
      source_surface_->fit_all();
    }
  }

  MovingSource& source() { return source_; }
  RegistrationTarget& target() { return target_; }

  /// Iterates from a local transform; returns the last one.
  Similarity run(Similarity local, Alignment& result) {
    const double unit_m = level_.voxel_m > 0.0 ? level_.voxel_m : level_.max_distance_m / 4.0;
    const StepLimits limits{options_.min_rotation_rad, options_.min_translation_voxels * unit_m, options_.min_scale};
    result.converged = false;
    for (int i = 0; i < level_.max_iterations && !result.converged; ++i) {
      field_ = source_.nearest(target_.index, local);
      if (options_.metric != IcpMetric::kPoint) target_.fit_surface(field_, level_.max_distance_m);
      const Similarity next = options_.metric == IcpMetric::kPoint ? closed_form_step(local) : gauss_newton_step(local);
      result.converged = limits.hold(local, next, source_.center());
      local = next;
      ++result.iterations;
    }
    return local;
  }

 private:
  struct Match {
    Eigen::Vector3d p, q;  ///< offsets from the target's origin
    std::uint32_t target_slot;
    double weight;  ///< 0: no match
  };

  Match match(const Similarity& local, std::size_t slot) const {
    Match m{MovingSource::moved(local, source_.points(), slot),
            target_.index.points.offset(field_.slot[slot]).cast<double>(), field_.slot[slot], 0.0};
    const double distance_m = std::sqrt(field_.sq_dist[slot]);
    if (distance_m > level_.max_distance_m) return m;
    const double residual_m = options_.metric == IcpMetric::kPlane
                                  ? std::abs((m.p - m.q).dot(target_.surface.normal(m.target_slot)))
                                  : distance_m;
    m.weight = robust_weight(options_.kernel, residual_m, options_.kernel_width * level_.max_distance_m);
    return m;
  }

  Similarity closed_form_step(const Similarity& local) const {
    const PairMoments moments = pair_moments(source_.size(), [&](std::size_t slot) {
      const Match m = match(local, slot);
      return WeightedPair{source_.points().offset(slot).cast<double>(), m.q, m.weight};
    });
    if (moments.n < 3) fail_no_overlap(moments.n, level_.max_distance_m);
    return fit_similarity(moments, {options_.with_scale, local.scale, 0.0});
  }

  Similarity gauss_newton_step(const Similarity& local) const {
    const Eigen::Vector3d pivot = local * source_.center();
    const auto equations = ordered_sum<NormalEquations>(source_.size(), kPointChunk, [&](std::size_t b, std::size_t e) {
      NormalEquations part;
      for (std::size_t slot = b; slot < e; ++slot) add(local, slot, pivot, part);
      return part;
    });
    if (equations.n < 3) fail_no_overlap(equations.n, level_.max_distance_m);
    const double lever_m = std::sqrt(equations.H.topLeftCorner<3, 3>().trace() / equations.H.block<3, 3>(3, 3).trace());
    if (!(lever_m > 0.0)) throw UnsupportedError("the matched points have no surface: they coincide or are collinear");
    return solve_step(equations, options_.with_scale, lever_m, pivot) * local;
  }

  void add(const Similarity& local, std::size_t slot, const Eigen::Vector3d& pivot, NormalEquations& part) const {
    const Match m = match(local, slot);
    if (m.weight == 0.0) return;
    const Eigen::Vector3d normal = target_.surface.normal(m.target_slot);
    if (options_.metric == IcpMetric::kPlane) {
      part.add_plane(m.p - pivot, m.p - m.q, normal, m.weight);
      return;
    }
    const Eigen::Vector3d source_normal = local.rotation * source_surface_->normal(slot);
    const Eigen::Matrix3d covariance =
        2.0 * Eigen::Matrix3d::Identity() -
        (1.0 - kPlaneThickness) * (normal * normal.transpose() + source_normal * source_normal.transpose());
    part.add(m.p - pivot, m.p - m.q, covariance.inverse(), m.weight);
  }

  const IcpLevel& level_;
  const IcpOptions& options_;
  MovingSource source_;
  RegistrationTarget target_;
  std::optional<Bvh> source_index_;        ///< GICP only
  std::optional<Surface> source_surface_;  ///< GICP only
  NearestField field_;
};

}  // namespace

void check_options(const IcpOptions& options) {
  if (options.levels.empty()) throw UsageError("levels is empty: at least one is needed");
  for (const IcpLevel& level : options.levels) {
    require(level.voxel_m >= 0.0 && std::isfinite(level.voxel_m), "voxel_m", level.voxel_m, "0 or more is needed");
    require(level.max_distance_m > 0.0 && std::isfinite(level.max_distance_m), "max_distance_m", level.max_distance_m,
            "a distance above 0 is needed");
    require(level.max_iterations > 0, "max_iterations", level.max_iterations, "at least 1 is needed");
  }
  require(options.kernel_width > 0.0, "kernel_width", options.kernel_width, "a share above 0 is needed");
  require(options.neighbors >= 5 && options.neighbors <= 64, "neighbors", options.neighbors, "5 to 64 are possible");
}

std::vector<IcpLevel> coarse_to_fine(double voxel_m, double max_distance_m, int max_iterations) {
  std::vector<IcpLevel> levels;
  for (const double factor : {4.0, 2.0, 1.0}) {
    levels.push_back({factor * voxel_m, factor * max_distance_m, max_iterations});
  }
  return levels;
}

Alignment icp(const PointCloud& source, const PointCloud& target, const Eigen::Matrix4d& T_initial,
              const IcpOptions& options) {
  check_options(options);
  Alignment result;
  result.method = kMetricNames[static_cast<std::size_t>(options.metric)];
  Similarity T = similarity_from(T_initial);
  for (std::size_t i = 0; i < options.levels.size(); ++i) {
    const IcpLevel& settings = options.levels[i];
    Level level(source, target, T.scale, settings, options);
    const Similarity local = level.run(local_transform(T, source.origin, target.origin), result);
    T = world_transform(local, source.origin, target.origin);
    if (i + 1 == options.levels.size()) {
      result.voxel_m = settings.voxel_m;
      result.max_distance_m = settings.max_distance_m;
      assess(level.source(), level.target(), local, settings.max_distance_m, options.with_scale, result);
    }
  }
  result.T_dst_src = T.matrix();
  result.scale = T.scale;
  tell_convergence(result);
  return result;
}

}  // namespace cmap
