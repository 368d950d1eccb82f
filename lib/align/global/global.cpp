#include "cmap/align/global.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "cmap/align/icp.hpp"
#include "cmap/core/error.hpp"
#include "global/pose_search.hpp"
#include "verdict/judge.hpp"

namespace cmap {
namespace {

constexpr std::size_t kFewestPoints = 10;
constexpr double kLeastScale = 1e-3, kMostScale = 1e3;

void require_points(const PointCloud& cloud, const char* which) {
  if (cloud.size() < kFewestPoints) {
    throw UnsupportedError(fmt::format("{} points of the {} are too few for global registration", cloud.size(), which));
  }
  if (!(size_of(cloud) > 0.0)) throw UnsupportedError(fmt::format("all points of the {} coincide", which));
}

/// Poses from all ways in which the source may stand, until one convinces; the source is left standing so.
std::optional<Finalists> best_poses(PoseSearch& search) {
  constexpr double kConvincing = 0.7, kEnough = 50.0;
  std::optional<Finalists> best;
  for (std::size_t stance = 0; stance < search.n_stances(); ++stance) {
    if (stance > 0) search.stand(stance);
    const std::vector<JudgedPose> poses = search.search();
    if (poses.empty()) continue;
    Finalists found = finalists_of(search, poses);
    if (!best || found.best.worth.evidence > best->best.worth.evidence) best = std::move(found);
    if (best->best.worth.score > kConvincing && best->best.worth.support > kEnough) return best;
  }
  if (best) search.stand_as(best->best.local);
  return best;
}

/// What one scale gives.
struct Attempt {
  double scale = 1.0;
  PointCloud source;  ///< in the target's units
  std::unique_ptr<PoseSearch> search;
  std::optional<Finalists> finalists;

  double evidence() const {
    return finalists ? finalists->best.worth.evidence : -std::numeric_limits<double>::infinity();
  }
};

Attempt attempt_at(double scale, const PointCloud& source, const PointCloud& target, const GlobalOptions& options) {
  Attempt attempt{scale, scaled_by(scale, source), nullptr, std::nullopt};
  const double voxel_m = options.voxel_m.value_or(search_voxel_m(attempt.source, target));
  attempt.search = std::make_unique<PoseSearch>(attempt.source, target, voxel_m);
  attempt.finalists = best_poses(*attempt.search);
  return attempt;
}

/// Scales to try, the most plausible first: where it is asked for, the one that gives the maps one size, and others
/// around it in steps that the columns forgive.
std::vector<double> scales_to_try(const PointCloud& source, const PointCloud& target, bool with_scale) {
  if (!with_scale) return {1.0};
  constexpr double kStep = 1.04;
  constexpr int kSteps = 16;  // a factor of 1.9 each way
  const double same_size = size_of(target) / size_of(source);
  std::vector<double> scales{same_size};
  for (int step = 1; step <= kSteps; ++step) {
    scales.push_back(same_size * std::pow(kStep, step));
    scales.push_back(same_size * std::pow(kStep, -step));
  }
  std::erase_if(scales, [](double scale) { return scale < kLeastScale / kStep || scale > kMostScale * kStep; });
  if (scales.empty()) {
    throw UnsupportedError(
        fmt::format("the maps' sizes differ by a factor of {:.3g}: scales from {:g} to {:g} are searched", same_size,
                    kLeastScale, kMostScale));
  }
  return scales;
}

/// The best attempt of all scales; one that convinces ends the search.
Attempt best_attempt(const PointCloud& source, const PointCloud& target, std::span<const double> scales,
                     const GlobalOptions& options) {
  constexpr double kConvincing = 0.35, kEnough = 50.0;  // a scale that is 2 % off leaves this much
  Attempt best;
  for (const double scale : scales) {
    Attempt attempt = attempt_at(scale, source, target, options);
    if (attempt.evidence() > best.evidence()) best = std::move(attempt);
    if (best.finalists && best.finalists->best.worth.score > kConvincing &&
        best.finalists->best.worth.support > kEnough) {
      break;
    }
  }
  return best;
}

/// What was searched, behind what was not found.
std::string searched(std::span<const double> scales) {
  if (scales.size() < 2) return "";
  const auto [least, most] = std::ranges::minmax(scales);
  return fmt::format("; scales from {:.3g} to {:.3g} were searched", least, most);
}

IcpOptions refinement(double voxel_m, double fine_voxel_m, bool with_scale) {
  constexpr std::size_t kMostPoints = 30'000;
  IcpOptions options;
  options.metric = IcpMetric::kGicp;
  options.with_scale = with_scale;
  options.levels.clear();
  for (double size_m = with_scale ? 2.0 * voxel_m : 0.5 * voxel_m; size_m > 3.0 * fine_voxel_m; size_m *= 0.5) {
    options.levels.push_back({size_m, 3.0 * size_m, 50, kMostPoints});
  }
  options.levels.push_back({fine_voxel_m, 10.0 * fine_voxel_m, 50, kMostPoints});
  return options;
}

Alignment registered(const PointCloud& source, const PointCloud& target, std::span<const double> scales,
                     const GlobalOptions& options) {
  Attempt attempt = best_attempt(source, target, scales, options);
  if (!attempt.finalists) {
    throw UnsupportedError("no pose of the source meets the target: the clouds have no shape to match");
  }
  const double voxel_m = attempt.search->voxel_m();
  Similarity guess = world_transform(attempt.finalists->best.local, attempt.source.origin, target.origin);
  guess.scale = attempt.scale;
  Alignment result = icp(source, target, guess.matrix(),
                         refinement(voxel_m, options.fine_voxel_m.value_or(voxel_m / 8.0), options.with_scale));
  result.method = "global";
  if (options.with_scale) {
    result.judgment = judge_alignment(source, target, result);
    if (!is_trusted(result.judgment.verdict)) result.judgment.reason += searched(scales);
  } else {
    const Similarity local = local_transform(similarity_from(result.T_dst_src), source.origin, target.origin);
    result.judgment = judgment_of(*attempt.search, local, *attempt.finalists, source.origin, target.origin);
    tell_weak(result, result.judgment);
  }
  return result;
}

}  // namespace

Alignment global_registration(const PointCloud& source, const PointCloud& target, const GlobalOptions& options) {
  require_points(source, "source");
  require_points(target, "target");
  if (options.voxel_m && !(*options.voxel_m > 0.0)) throw UsageError("voxel_m must be above 0");
  if (options.fine_voxel_m && !(*options.fine_voxel_m > 0.0)) throw UsageError("fine_voxel_m must be above 0");
  const std::vector<double> scales = scales_to_try(source, target, options.with_scale);
  try {
    return registered(source, target, scales, options);
  } catch (const UnsupportedError& error) {
    throw UnsupportedError(error.what() + searched(scales));
  }
}

}  // namespace cmap
