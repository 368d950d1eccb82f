#include "cmap/align/icp.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <optional>

#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "icp/icp_levels.hpp"
#include "icp/require.hpp"

namespace cmap {
namespace {

constexpr double kPlaneThickness = 1e-3;  ///< variance across a plane over that along it (Segal et al.)

constexpr std::array<const char*, 3> kMetricNames{"icp", "plane", "gicp"};

/// One level's steps by options.metric.
class MetricSteps {
 public:
  MetricSteps(LevelMatches& level, const IcpOptions& options) : level_(level), options_(options) {
    if (options.metric == IcpMetric::kGicp) source_surface_.emplace(level, options.neighbors);
  }

  Similarity next(const Similarity& local) const {
    if (options_.metric == IcpMetric::kPoint) return closed_form_step(local);
    level_.target.fit_surface(level_.field, level_.settings.max_distance_m);
    return gauss_newton_step(local);
  }

 private:
  /// 0: no match.
  double weight(const MatchedPoints& m) const {
    const double max_distance_m = level_.settings.max_distance_m;
    if (m.distance_m > max_distance_m) return 0.0;
    const double residual_m = options_.metric == IcpMetric::kPlane
                                  ? std::abs((m.p - m.q).dot(level_.target.surface.normal(m.target_slot)))
                                  : m.distance_m;
    return robust_weight(options_.kernel, residual_m, options_.kernel_width * max_distance_m);
  }

  Similarity closed_form_step(const Similarity& local) const {
    const MovingSource& source = level_.source;
    const PairMoments moments = pair_moments(source.size(), [&](std::size_t slot) {
      const MatchedPoints m = matched_points(level_, local, slot);
      return WeightedPair{source.points().offset(slot).cast<double>(), m.q, weight(m)};
    });
    if (moments.n < 3) fail_no_overlap(moments.n, level_.settings.max_distance_m);
    return fit_similarity(moments, {options_.with_scale, local.scale, 0.0});
  }

  Similarity gauss_newton_step(const Similarity& local) const {
    const Eigen::Vector3d pivot = local * level_.source.center();
    const NormalEquations equations =
        equations_of(level_, [&](std::size_t slot, NormalEquations& part) { add(local, slot, pivot, part); });
    return solve_step(equations, options_.with_scale, lever_m(equations), pivot) * local;
  }

  void add(const Similarity& local, std::size_t slot, const Eigen::Vector3d& pivot, NormalEquations& part) const {
    const MatchedPoints m = matched_points(level_, local, slot);
    const double pair_weight = weight(m);
    if (pair_weight == 0.0) return;
    const Eigen::Vector3d normal = level_.target.surface.normal(m.target_slot);
    if (options_.metric == IcpMetric::kPlane) {
      part.add_plane(m.p - pivot, m.p - m.q, normal, pair_weight);
      return;
    }
    const Eigen::Vector3d source_normal = local.rotation * source_surface_->normal(slot);
    const Eigen::Matrix3d covariance =
        2.0 * Eigen::Matrix3d::Identity() -
        (1.0 - kPlaneThickness) * (normal * normal.transpose() + source_normal * source_normal.transpose());
    part.add(m.p - pivot, m.p - m.q, covariance.inverse(), pair_weight);
  }

  LevelMatches& level_;
  const IcpOptions& options_;
  std::optional<SourceSurface> source_surface_;  ///< GICP only
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

std::function<NextTransform(LevelMatches&)> icp_metric(const IcpOptions& options) {
  return metric_of<MetricSteps>(options);
}

Alignment icp(const PointCloud& source, const PointCloud& target, const Eigen::Matrix4d& T_initial,
              const IcpOptions& options) {
  Alignment result = iterate_levels(source, target, T_initial, options, icp_metric(options));
  result.method = kMetricNames[static_cast<std::size_t>(options.metric)];
  return result;
}

}  // namespace cmap
