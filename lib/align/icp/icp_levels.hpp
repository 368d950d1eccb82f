#pragma once

#include <functional>
#include <memory>

#include "cmap/align/icp.hpp"
#include "cmap/core/parallel.hpp"
#include "icp/registration_cloud.hpp"

namespace cmap {

/// A level's thinned source: all of it in order of its slots, and the part that takes part.
struct ThinnedSource {
  ThinnedSource(const PointCloud& source, double voxel_m, std::size_t most_points);

  PointBlocks all;
  Array<std::uint32_t> chosen;  ///< slots of `all`; empty: every one
};

/// What an iteration sees: one level's clouds and the matches at the present transform.
struct LevelMatches {
  LevelMatches(const PointCloud& source, const PointCloud& target, double scale, const IcpLevel& level, int neighbors);

  IcpLevel settings;
  ThinnedSource thinned;
  MovingSource source;
  RegistrationTarget target;
  NearestField field;
};

/// Planes through a level's source, in its own frame.
class SourceSurface {
 public:
  SourceSurface(const LevelMatches& level, int neighbors);
  SourceSurface(const SourceSurface&) = delete;
  SourceSurface& operator=(const SourceSurface&) = delete;

  /// Of a slot of the level's moving source.
  Eigen::Vector3d normal(std::size_t slot) const { return surface_.normal(chosen_.empty() ? slot : chosen_[slot]); }

 private:
  Bvh index_;
  Surface surface_;
  const Array<std::uint32_t>& chosen_;
};

/// A source's point at `local`, and the target's nearest: offsets from the target's origin.
struct MatchedPoints {
  Eigen::Vector3d p, q;
  std::uint32_t target_slot;
  double distance_m;
};
MatchedPoints matched_points(const LevelMatches& level, const Similarity& local, std::size_t slot);

/// The transform after one more step, from the level's matches at `local`.
using NextTransform = std::function<Similarity(const Similarity& local)>;

/// The last level's outcome where it stands alone.
struct LevelRun {
  Similarity local;
  int iterations = 0;
  bool converged = false;
};

/// Iterates one level from a local transform. Throws UnsupportedError where fewer than 3 points match.
LevelRun run_level(LevelMatches& level, const NextTransform& next_from, const Similarity& start,
                   const IcpOptions& options);

/// Iterates level by level, from matches to steps; all that differs is what a step minimizes: `metric` makes a level's
/// steps (options.metric is not read). Fills everything but the method's name. Throws as icp() does.
Alignment iterate_levels(const PointCloud& source, const PointCloud& target, const Eigen::Matrix4d& T_initial,
                         const IcpOptions& options, const std::function<NextTransform(LevelMatches&)>& metric);

/// The metric whose steps a class makes: Steps(level, options) with next(local). `options` must outlive it.
template <class Steps>
std::function<NextTransform(LevelMatches&)> metric_of(const IcpOptions& options) {
  return [&options](LevelMatches& level) -> NextTransform {
    const auto steps = std::make_shared<const Steps>(level, options);
    return [steps](const Similarity& local) { return steps->next(local); };
  };
}

/// The steps of icp() by options.metric; `options` must outlive it.
std::function<NextTransform(LevelMatches&)> icp_metric(const IcpOptions& options);

/// The equations of all slots, in a fixed order; add(slot, part) adds those of one. Throws UnsupportedError where fewer
/// than 3 match.
template <class Add>
NormalEquations equations_of(const LevelMatches& level, Add&& add) {
  constexpr std::size_t kPointChunk = 1024;
  const auto equations =
      ordered_sum<NormalEquations>(level.source.size(), kPointChunk, [&](std::size_t b, std::size_t e) {
        NormalEquations part;
        for (std::size_t slot = b; slot < e; ++slot) add(slot, part);
        return part;
      });
  if (equations.n < 3) fail_no_overlap(equations.n, level.settings.max_distance_m);
  return equations;
}

/// What a turn moves the matched points by, RMS, m per rad. Throws UnsupportedError where they have no surface.
double lever_m(const NormalEquations& equations);

}  // namespace cmap
