#include "loops/loop_consistency.hpp"

#include <fmt/format.h>

#include <cmath>

#include "loops/drift_bound.hpp"

namespace cmap {
namespace {

enum class Opinion { kNone, kFor, kAgainst };

struct Judge {
  std::span<const Keyframe> keyframes;
  std::span<const double> paths_m;
  const LoopOptions& options;

  Eigen::Isometry3d motion(std::size_t a, std::size_t b) const {
    return keyframes[a].T_world_body.inverse() * keyframes[b].T_world_body;
  }

  Opinion between(const LoopCandidate& a, const LoopCandidate& b) const {
    const double path_m = std::abs(paths_m[a.from] - paths_m[b.from]) + std::abs(paths_m[a.to] - paths_m[b.to]);
    if (path_m > 3.0 * options.submap_m) return Opinion::kNone;
    const Eigen::Isometry3d by_a = motion(b.from, a.from) * a.T_from_to * motion(a.to, b.to);
    DriftBound bound = drift_bound(path_m, options);
    bound.m = 2.0 * options.voxel_m + options.drift_share * path_m;  // what is near needs no allowance for the start
    return difference(by_a, b.T_from_to).within(bound) ? Opinion::kFor : Opinion::kAgainst;
  }
};

/// Which accepted loop has most against it, and that by more than is for it.
LoopCandidate* worst_of(std::span<LoopCandidate> candidates, const Judge& judge) {
  LoopCandidate* worst = nullptr;
  int worst_against = 0;
  for (LoopCandidate& candidate : candidates) {
    int votes_for = 0, against = 0;
    for (const LoopCandidate& other : candidates) {
      if (!candidate.accepted || !other.accepted || &candidate == &other) continue;
      const Opinion opinion = judge.between(candidate, other);
      votes_for += opinion == Opinion::kFor ? 1 : 0;
      against += opinion == Opinion::kAgainst ? 1 : 0;
    }
    if (against == 0 || against < votes_for) continue;
    const bool is_worse = worst == nullptr || against > worst_against ||
                          (against == worst_against && candidate.verdict.score <= worst->verdict.score);
    if (!is_worse) continue;
    worst = &candidate;
    worst_against = against;
  }
  if (worst != nullptr) worst->reason = fmt::format("{} other loops nearby contradict it", worst_against);
  return worst;
}

}  // namespace

void reject_contradicted(std::span<LoopCandidate> candidates, std::span<const Keyframe> keyframes,
                         std::span<const double> paths_m, const LoopOptions& options) {
  const Judge judge{keyframes, paths_m, options};
  while (LoopCandidate* const worst = worst_of(candidates, judge)) worst->accepted = false;
}

}  // namespace cmap
