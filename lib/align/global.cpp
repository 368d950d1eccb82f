#include "cmap/align/global.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/align/icp.hpp"
#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "judge.hpp"
#include "pose_search.hpp"

namespace cmap {
namespace {

constexpr double kVoxelsPerSize = 100.0;
constexpr double kMostVoxelsPerSize = 300.0;  ///< of the larger map
constexpr std::size_t kFewestPoints = 10;

/// What a box with the same spread would have as its diagonal: blind to a few strays.
double size_of(const PointCloud& cloud) {
  const PairMoments spread = pair_moments(cloud.size(), [&](std::size_t i) {
    const Eigen::Vector3d p = cloud.positions[i].cast<double>();
    return WeightedPair{p, p, 1.0};
  });
  return std::sqrt(12.0 * spread.scatter_p.trace() / spread.weight);
}

void require_points(const PointCloud& cloud, const char* which) {
  if (cloud.size() < kFewestPoints) {
    throw UnsupportedError(fmt::format("{} points of the {} are too few for global registration", cloud.size(), which));
  }
  if (!(size_of(cloud) > 0.0)) throw UnsupportedError(fmt::format("all points of the {} coincide", which));
}

/// So that a voxel holds more than one point.
double wide_enough(const PointCloud& cloud, double voxel_m) {
  constexpr double kKept = 0.7, kWider = 1.4;
  constexpr int kTries = 12;
  for (int i = 0; i < kTries; ++i, voxel_m *= kWider) {
    const auto n_left = static_cast<double>(thinned_to(cloud, voxel_m).size());
    if (n_left < kKept * static_cast<double>(cloud.size())) break;
  }
  return voxel_m;
}

double search_voxel_m(const PointCloud& source, const PointCloud& target) {
  const double a = size_of(source), b = size_of(target);
  const double voxel_m = std::max(std::min(a, b) / kVoxelsPerSize, std::max(a, b) / kMostVoxelsPerSize);
  return std::max(wide_enough(source, voxel_m), wide_enough(target, voxel_m));
}

/// Poses from all ways in which the source may stand, until one convinces.
Finalists best_poses(PoseSearch& search) {
  constexpr double kConvincing = 0.7, kEnough = 50.0;
  std::optional<Finalists> best;
  for (std::size_t stance = 0; stance < search.n_stances(); ++stance) {
    if (stance > 0) search.stand(stance);
    const std::vector<JudgedPose> poses = search.search();
    if (poses.empty()) continue;
    Finalists found = finalists_of(search, poses);
    if (!best || found.best.worth.evidence > best->best.worth.evidence) best = std::move(found);
    if (best->best.worth.score > kConvincing && best->best.worth.support > kEnough) break;
  }
  if (!best) throw UnsupportedError("no pose of the source meets the target: the clouds have no shape to match");
  return *best;
}

IcpOptions refinement(double voxel_m, double fine_voxel_m, bool with_scale) {
  constexpr std::size_t kMostPoints = 30'000;
  IcpOptions options;
  options.metric = IcpMetric::kGicp;
  options.with_scale = with_scale;
  options.levels.clear();
  for (double size_m = 0.5 * voxel_m; size_m > 3.0 * fine_voxel_m; size_m *= 0.5) {
    options.levels.push_back({size_m, 3.0 * size_m, 50, kMostPoints});
  }
  options.levels.push_back({fine_voxel_m, 10.0 * fine_voxel_m, 50, kMostPoints});
  return options;
}

}  // namespace

Alignment global_registration(const PointCloud& source, const PointCloud& target, const GlobalOptions& options) {
  require_points(source, "source");
  require_points(target, "target");
  const double voxel_m = options.voxel_m.value_or(search_voxel_m(source, target));
  const double fine_voxel_m = options.fine_voxel_m.value_or(voxel_m / 8.0);
  if (!(voxel_m > 0.0) || !(fine_voxel_m > 0.0)) throw UsageError("voxel_m must be above 0");
  PoseSearch search(source, target, voxel_m);
  const Finalists finalists = best_poses(search);
  const Similarity guess = world_transform(finalists.best.local, source.origin, target.origin);
  Alignment result =
      icp(source, target, guess.matrix(), refinement(voxel_m, fine_voxel_m, options.with_scale));
  result.method = "global";
  result.judgment = judgment_of(finalists, source.origin, target.origin);
  return result;
}

}  // namespace cmap
