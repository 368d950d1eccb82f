#include "icp/registration_cloud.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/spatial/k_nearest.hpp"

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
  throw UnsupportedError(fmt::format(
      "the alignment is not determined: {} is free (condition {:.1e}), as where a single plane or a corridor "
      "matches; maps that share more may help, or a start nearer to the right pose",
      found.weakest, found.condition));
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

Array<std::uint32_t> every_few(std::size_t n, std::size_t most) {
  Array<std::uint32_t> slots;
  const std::size_t step = (n + most - 1) / most;
  for (std::size_t slot = step / 2; slot < n; slot += step) slots.push_back(static_cast<std::uint32_t>(slot));
  return slots;
}

double median_spacing_m(const Bvh& index, const Array<std::uint32_t>& slots) {
  const Array<std::uint32_t> nearest_two = find_k_nearest(index, chosen_points(index.points, slots), 2);
  Array<double> spacing_m(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const std::uint32_t other = nearest_two[2 * i + 1];
    spacing_m[i] = other == kNoNeighbor ? 0.0 : (index.points.offset(slots[i]) - index.points.offset(other)).norm();
  }
  return upper_median(spacing_m);
}

void RegistrationTarget::fit_surface(const NearestField& field, double max_distance_m) {
  Array<std::uint32_t> matched;
  for (std::size_t i = 0; i < field.slot.size(); ++i) {
    if (field.sq_dist[i] <= max_distance_m * max_distance_m) matched.push_back(field.slot[i]);
  }
  surface.fit(matched);
}

namespace {

/// What assess() goes through: the matches at a pose.
struct Matches {
  const NearestField& field;
  const PointBlocks& source;
  const RegistrationTarget& target;
  const Similarity& local;
  double sq_max;

  bool is_match(std::size_t slot) const { return field.sq_dist[slot] <= sq_max; }
  Eigen::Vector3d normal(std::size_t slot) const { return target.surface.normal(field.slot[slot]); }
  WeightedPair pair(std::size_t slot) const {
    return {MovingSource::moved(local, source, slot), target.index.points.offset(field.slot[slot]).cast<double>(),
            is_match(slot) ? 1.0 : 0.0};
  }
  double to_surface_m(std::size_t slot) const {
    const WeightedPair both = pair(slot);
    return std::abs((both.p - both.q).dot(normal(slot)));
  }
};

/// Information of the matches whose distance to the surface is at most this.
Matrix7d information_of(const Matches& matches, const Eigen::Vector3d& center, double most_m, double noise_margin) {
  const auto sums = ordered_sum<NormalEquations>(matches.source.size, kNormalChunk, [&](std::size_t b, std::size_t e) {
    NormalEquations part;
    for (std::size_t slot = b; slot < e; ++slot) {
      if (!matches.is_match(slot) || matches.to_surface_m(slot) > most_m) continue;
      const Eigen::Vector3d normal = matches.normal(slot);
      const Eigen::Vector3d arm = matches.pair(slot).p - center;
      part.add_plane(arm, Eigen::Vector3d::Zero(), normal, 1.0);
      // Without what noise of the normals alone adds: a noisy plane must not seem to hold itself in place.
      const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - normal * normal.transpose();
      const double noise = noise_margin * matches.target.surface.tilt_variance(matches.field.slot[slot]);
      part.add(arm, Eigen::Vector3d::Zero(), across, -noise);
    }
    return part;
  });
  return sums.H;
}

/// Variance of the gradient of half the sum of squares, from how it scatters among patches of neighboring matches:
/// neighbors share planes and roughness, and are not independent.
Matrix7d gradient_variance(const Matches& matches, const Eigen::Vector3d& center, double most_m) {
  constexpr std::size_t kPatch = 64;  // along the curve that the slots follow
  const auto sums = ordered_sum<NormalEquations>(matches.source.size, kPatch, [&](std::size_t b, std::size_t e) {
    Vector7d gradient = Vector7d::Zero();
    NormalEquations patch;
    for (std::size_t slot = b; slot < e; ++slot) {
      if (!matches.is_match(slot) || matches.to_surface_m(slot) > most_m) continue;
      const WeightedPair both = matches.pair(slot);
      NormalEquations one;
      one.add_plane(both.p - center, both.p - both.q, matches.normal(slot), 1.0);
      gradient += one.g;
    }
    patch.H = gradient * gradient.transpose();
    return patch;
  });
  return sums.H;
}

/// From the matches' center to the farthest corner of the moved source's box.
double farthest_corner_m(const Matches& matches, const Eigen::Vector3d& center) {
  Eigen::Vector3f low = matches.source.offset(0), high = low;
  for (std::size_t slot = 1; slot < matches.source.size; ++slot) {
    low = low.cwiseMin(matches.source.offset(slot));
    high = high.cwiseMax(matches.source.offset(slot));
  }
  double farthest = 0.0;
  for (const Eigen::Vector3d& corner : corners({low.cast<double>(), high.cast<double>()})) {
    farthest = std::max(farthest, (matches.local * corner - center).norm());
  }
  return farthest;
}

/// Spread of the distances to the surface, without those of other things: 1.48 times their median.
double spread_to_surface_m(const Matches& matches) {
  Array<double> distances;
  for (std::size_t slot = 0; slot < matches.source.size; ++slot) {
    if (matches.is_match(slot)) distances.push_back(matches.to_surface_m(slot));
  }
  return 1.4826 * upper_median(distances);
}

}  // namespace

void assess(MovingSource& source, RegistrationTarget& target, const Similarity& local, double max_distance_m,
            bool with_scale, Alignment& result) {
  const NearestField field = source.nearest(target.index, local);
  target.fit_surface(field, max_distance_m);
  const Matches matches{field, source.points(), target, local, max_distance_m * max_distance_m};
  const PairMoments moments = pair_moments(source.size(), [&](std::size_t slot) { return matches.pair(slot); });
  if (moments.n < 3) fail_no_overlap(moments.n, max_distance_m);
  double sum_sq = 0.0;
  for (const double sq_dist : field.sq_dist) sum_sq += sq_dist <= matches.sq_max ? sq_dist : 0.0;
  result.n_source = source.size();
  result.n_target = target.index.points.size;
  result.n_matches = moments.n;
  result.overlap = static_cast<double>(moments.n) / static_cast<double>(source.size());
  result.rmse_m = std::sqrt(sum_sq / static_cast<double>(moments.n));
  (void)fit_similarity(moments, ScaleModel{with_scale, 1.0, 0.0});  // refuses what has no spread
  const double lever_m = std::sqrt(moments.scatter_p.trace() / moments.weight);
  const Matrix7d all = information_of(matches, moments.mean_p, std::numeric_limits<double>::infinity(), kNoiseMargin);
  const Observability found = observability(all, with_scale, lever_m);
  require_observable(found);
  tell_observability(found, result);
  const double spread_m = spread_to_surface_m(matches);
  result.standard_errors = standard_errors(information_of(matches, moments.mean_p, 3.0 * spread_m, 1.0),
                                           gradient_variance(matches, moments.mean_p, 3.0 * spread_m), with_scale,
                                           lever_m, farthest_corner_m(matches, moments.mean_p));
}

bool StepLimits::hold(const Similarity& before, const Similarity& after, const Eigen::Vector3d& center) const {
  return rotation_angle_rad(after.rotation * before.rotation.transpose()) < rotation_rad &&
         (after * center - before * center).norm() < translation_m &&
         std::abs(after.scale / before.scale - 1.0) < scale;
}

}  // namespace cmap
