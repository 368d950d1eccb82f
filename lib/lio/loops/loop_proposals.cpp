#include "loops/loop_proposals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cmap/core/parallel.hpp"
#include "loops/drift_bound.hpp"

namespace cmap {
namespace {

/// An earlier submap and how far it is from being the same place.
struct Rated {
  std::size_t submap;
  double cost;
};

/// The `most` of least cost, none within half a submap of path of a better one.
std::vector<std::size_t> best_apart(std::vector<Rated> rated, std::span<const Submap> submaps, int most,
                                    double apart_m) {
  std::stable_sort(rated.begin(), rated.end(), [](const Rated& a, const Rated& b) { return a.cost < b.cost; });
  std::vector<std::size_t> best;
  for (const Rated& r : rated) {
    if (best.size() >= static_cast<std::size_t>(most)) break;
    const auto is_apart = [&](std::size_t b) {
      return std::abs(submaps[b].path_m - submaps[r.submap].path_m) >= apart_m;
    };
    if (std::all_of(best.begin(), best.end(), is_apart)) best.push_back(r.submap);
  }
  return best;
}

/// Whether the way between them went elsewhere: along a straight street what lies ahead is seen long before, and is no
/// loop, as the odometry has registered onto it all the way.
bool is_detour(const Submap& from, const Submap& to, std::span<const Eigen::Isometry3d> poses) {
  constexpr double kLeastDetour = 2.0;
  const double distance_m = (poses[from.center].translation() - poses[to.center].translation()).norm();
  return to.path_m - from.path_m >= kLeastDetour * distance_m;
}

/// For every submap, those before it that are no neighbors on the way and that rate(from, to) gives a cost.
template <class Rate>
std::vector<LoopProposal> proposals_by(std::span<const Submap> submaps, std::span<const Eigen::Isometry3d> poses,
                                       const LoopOptions& options, int most, LoopSource source, Rate&& rate) {
  std::vector<std::vector<std::size_t>> chosen(submaps.size());
  parallel_chunks(submaps.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t to = begin; to < end; ++to) {
      std::vector<Rated> rated;
      for (std::size_t from = 0; from < to; ++from) {
        if (submaps[to].path_m - submaps[from].path_m < options.min_path_m) break;
        if (!is_detour(submaps[from], submaps[to], poses)) continue;
        const double cost = rate(from, to);
        if (std::isfinite(cost)) rated.push_back({from, cost});
      }
      chosen[to] = best_apart(std::move(rated), submaps, most, 0.5 * options.submap_m);
    }
  });
  std::vector<LoopProposal> proposals;
  for (std::size_t to = 0; to < submaps.size(); ++to) {
    for (const std::size_t from : chosen[to]) proposals.push_back({from, to, source});
  }
  return proposals;
}

constexpr double kNo = std::numeric_limits<double>::infinity();

/// Whether the centers may be within three revisit_m of each other, as odometry drifts.
bool may_overlap(const Submap& from, const Submap& to, std::span<const Eigen::Isometry3d> poses,
                 const LoopOptions& options) {
  const double distance_m = (poses[from.center].translation() - poses[to.center].translation()).norm();
  return distance_m <= 3.0 * options.revisit_m + drift_bound(to.path_m - from.path_m, options).m;
}

}  // namespace

std::vector<LoopProposal> pose_proposals(std::span<const Submap> submaps, std::span<const Eigen::Isometry3d> poses,
                                         const LoopOptions& options, bool bounded) {
  const auto rate = [&](std::size_t from, std::size_t to) {
    const double distance_m =
        (poses[submaps[from].center].translation() - poses[submaps[to].center].translation()).norm();
    const double drift_m = bounded ? drift_bound(submaps[to].path_m - submaps[from].path_m, options).m : 0.0;
    return distance_m <= options.revisit_m + drift_m ? distance_m : kNo;
  };
  const LoopSource source = bounded ? LoopSource::kPose : LoopSource::kCorrected;
  return proposals_by(submaps, poses, options, options.pose_candidates, source, rate);
}

std::vector<LoopProposal> descriptor_proposals(std::span<const Submap> submaps,
                                               std::span<const RingDescriptor> descriptors,
                                               std::span<const Eigen::Isometry3d> poses, const LoopOptions& options) {
  const auto rate = [&](std::size_t from, std::size_t to) {
    if (!may_overlap(submaps[from], submaps[to], poses, options)) return kNo;
    const double similarity = best_turn(descriptors[to], descriptors[from]).similarity;
    return similarity >= options.least_similarity ? -similarity : kNo;
  };
  return proposals_by(submaps, poses, options, options.descriptor_candidates, LoopSource::kDescriptor, rate);
}

std::vector<LoopProposal> without_repeats(std::vector<LoopProposal> proposals) {
  const auto key = [](const LoopProposal& p) { return std::pair(p.to, p.from); };
  std::stable_sort(proposals.begin(), proposals.end(),
                   [&](const LoopProposal& a, const LoopProposal& b) { return key(a) < key(b); });
  const auto repeats = [&](const LoopProposal& a, const LoopProposal& b) { return key(a) == key(b); };
  proposals.erase(std::unique(proposals.begin(), proposals.end(), repeats), proposals.end());
  return proposals;
}

}  // namespace cmap
