#include "registration_cloud.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/voxel_map.hpp"

namespace cmap {
namespace {

constexpr std::size_t kNormalChunk = 1024;

/// Planes, spheres and corridors with noise or curvature look determined to up to this times the variance of their
/// normals' tilt; rooms, towns and LiDAR scans lose a few percent of their information to it.
constexpr double kNoiseMargin = 2.0;

/// A surface that slides in itself up to normals this noisy (1e-3 rad) determines nothing; up to the second it is weak.
constexpr double kUndeterminedCondition = 1e-6;

void require_observable(const Observability& found) {
  if (found.condition > kUndeterminedCondition) return;
  throw UnsupportedError(
      fmt::format("the alignment is not determined: {} is free (condition {:.1e})", found.weakest, found.condition));
}

}  // namespace

PointCloud thinned_to(const PointCloud& cloud, double voxel_m) {
  if (cloud.positions.empty()) throw std::invalid_argument("a registration needs points");
  return voxel_m > 0.0 ? voxel_thinned(cloud, voxel_m) : cloud;
}

void fail_no_overlap(std::size_t n_matches, double max_distance_m) {
  throw UnsupportedError(
      fmt::format("no overlap: {} points of the source have a target point within {:.4g} m; start "
                  "nearer (an initial transform), or allow more distance",
                  n_matches, max_distance_m));
}

void RegistrationTarget::fit_surface(const NearestField& field, double max_distance_m) {
  Array<std::uint32_t> matched;
  for (std::size_t i = 0; i < field.slot.size(); ++i) {
    if (field.sq_dist[i] <= max_distance_m * max_distance_m) matched.push_back(field.slot[i]);
  }
  surface.fit(matched);
}

void assess(MovingSource& source, RegistrationTarget& target, const Similarity& local, double max_distance_m,
            bool with_scale, Alignment& result) {
  const NearestField field = source.nearest(target.index, local);
  target.fit_surface(field, max_distance_m);
  const double sq_max = max_distance_m * max_distance_m;
  const auto pair_at = [&](std::size_t slot) {
    return WeightedPair{MovingSource::moved(local, source.points(), slot),
                        target.index.points.offset(field.slot[slot]).cast<double>(),
                        field.sq_dist[slot] <= sq_max ? 1.0 : 0.0};
  };
  const PairMoments moments = pair_moments(source.size(), pair_at);
  if (moments.n < 3) fail_no_overlap(moments.n, max_distance_m);
  const auto information = ordered_sum<NormalEquations>(source.size(), kNormalChunk, [&](std::size_t b, std::size_t e) {
    NormalEquations part;
    for (std::size_t slot = b; slot < e; ++slot) {
      if (!(field.sq_dist[slot] <= sq_max)) continue;
      const Eigen::Vector3d normal = target.surface.normal(field.slot[slot]);
      const Eigen::Vector3d arm = pair_at(slot).p - moments.mean_p;
      part.add_plane(arm, Eigen::Vector3d::Zero(), normal, 1.0);
      // Without what noise of the normals alone adds: a noisy plane must not seem to hold itself in place.
      const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - normal * normal.transpose();
      const double noise = kNoiseMargin * target.surface.tilt_variance(field.slot[slot]);
      part.add(arm, Eigen::Vector3d::Zero(), across, -noise);
    }
    return part;
  });
  double sum_sq = 0.0;
  for (const double sq_dist : field.sq_dist) sum_sq += sq_dist <= sq_max ? sq_dist : 0.0;
  result.n_source = source.size();
  result.n_target = target.index.points.size;
  result.n_matches = moments.n;
  result.overlap = static_cast<double>(moments.n) / static_cast<double>(source.size());
  result.rmse_m = std::sqrt(sum_sq / static_cast<double>(moments.n));
  (void)fit_similarity(moments, ScaleModel{with_scale, 1.0, 0.0});  // refuses what has no spread
  const double lever_m = std::sqrt(moments.scatter_p.trace() / moments.weight);
  const Observability found = observability(information.H, with_scale, lever_m);
  require_observable(found);
  tell_observability(found, result);
}

bool StepLimits::hold(const Similarity& before, const Similarity& after, const Eigen::Vector3d& center) const {
  return rotation_angle_rad(after.rotation * before.rotation.transpose()) < rotation_rad &&
         (after * center - before * center).norm() < translation_m &&
         std::abs(after.scale / before.scale - 1.0) < scale;
}

}  // namespace cmap
