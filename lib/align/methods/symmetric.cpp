#include <cmath>

#include "icp/icp_levels.hpp"
#include "methods/icp_method.hpp"

namespace cmap {
namespace {

/// One level's steps toward the least sum of ((p - q) . (n_p + n_q))^2, which is zero for a pair on one circle, not on
/// one line only: matches may slide along a curved surface.
class SymmetricSteps {
 public:
  SymmetricSteps(LevelMatches& level, const IcpOptions& options)
      : level_(level), options_(options), source_surface_(level, options.neighbors) {}

  Similarity next(const Similarity& local) const {
    level_.target.fit_surface(level_.field, level_.settings.max_distance_m);
    const Eigen::Vector3d pivot = local * level_.source.center();
    const NormalEquations equations =
        equations_of(level_, [&](std::size_t slot, NormalEquations& part) { add(local, slot, pivot, part); });
    return symmetric_step(solve_parameters(equations, options_.with_scale, lever_m(equations)), pivot) * local;
  }

 private:
  void add(const Similarity& local, std::size_t slot, const Eigen::Vector3d& pivot, NormalEquations& part) const {
    const auto [p, q, target_slot, distance_m] = matched_points(level_, local, slot);
    const double max_distance_m = level_.settings.max_distance_m;
    if (distance_m > max_distance_m) return;
    const Eigen::Vector3d normal =
        mean_normal(local.rotation * source_surface_.normal(slot), level_.target.surface.normal(target_slot));
    const double width_m = options_.kernel_width * max_distance_m;
    const double weight = robust_weight(options_.kernel, std::abs((p - q).dot(normal)), width_m);
    // Seen from halfway, p turns forth and q back.
    part.add_plane(0.5 * (p + q) - pivot, p - q, normal, weight);
  }

  /// Of normals of either sign; times the cosine between them, so that pairs count less the more they differ and not at
  /// all where the choice of sign turns over: matches across right angles would keep the steps from settling.
  static Eigen::Vector3d mean_normal(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const double cosine = a.dot(b);
    return 0.5 * (std::abs(cosine) * a + cosine * b);
  }

  /// Half the turn and scale, the translation, the other half. The equations hold the tangent of half the turn exactly,
  /// and the translation over its cosine.
  static Similarity symmetric_step(const Vector7d& x, const Eigen::Vector3d& pivot) {
    const Eigen::Vector3d turn = x.head<3>();
    const double half_rad = std::atan(0.5 * turn.norm());
    const Similarity half{std::exp(0.5 * x[6]), rotation_from(half_rad * turn.normalized()), Eigen::Vector3d::Zero()};
    const Eigen::Vector3d translation = std::cos(half_rad) * x.segment<3>(3);
    Similarity step = half * half;
    step.translation = pivot + half * translation - step.linear() * pivot;
    return step;
  }

  LevelMatches& level_;
  const IcpOptions& options_;
  SourceSurface source_surface_;
};

Alignment run_symmetric(const PointCloud& source, const PointCloud& target, const AlignOptions& options,
                        double voxel_m) {
  const IcpOptions how = icp_options(options, voxel_m);
  Alignment result = iterate_levels(source, target, options.T_initial, how, metric_of<SymmetricSteps>(how));
  result.method = "symmetric";
  return result;
}

}  // namespace

namespace registration {

/// Rusinkiewicz 2019, "A symmetric objective function for ICP".
extern constinit const RegistrationMethod symmetric{
    .name = "symmetric", .summary = "point to plane by the normals of both", .run = run_symmetric};

}  // namespace registration
}  // namespace cmap
