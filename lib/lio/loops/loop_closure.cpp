#include "cmap/lio/loop_closure.hpp"

#include <set>

#include "cmap/core/parallel.hpp"
#include "loops/keyframe_check.hpp"
#include "loops/loop_check.hpp"
#include "loops/loop_consistency.hpp"
#include "loops/loop_graph.hpp"
#include "loops/loop_proposals.hpp"
#include "loops/submaps.hpp"

namespace cmap {
namespace {

std::vector<SubmapView> views_of(std::span<const Submap> submaps, std::span<const Keyframe> keyframes,
                                 const LoopOptions& options) {
  std::vector<SubmapView> views(submaps.size());
  parallel_chunks(submaps.size(), 1, [&](std::size_t i, std::size_t) {
    const PointCloud points = points_of(submaps[i], keyframes, options.voxel_m);
    SubmapView& view = views[i];
    view.ground_m = ground_height_m(points);
    view.above = birds_eye(points, view.ground_m, options.reach_m);
    view.ring = ring_descriptor(view.above);
  });
  return views;
}

/// Pairs of the first round: by the odometry's poses and by looks.
std::vector<LoopProposal> first_proposals(std::span<const Submap> submaps, std::span<const SubmapView> views,
                                          std::span<const Eigen::Isometry3d> poses, const LoopOptions& options) {
  std::vector<LoopProposal> proposals = pose_proposals(submaps, poses, options);
  if (options.descriptor_candidates > 0) {
    std::vector<RingDescriptor> rings;
    for (const SubmapView& view : views) rings.push_back(view.ring);
    const std::vector<LoopProposal> alike = descriptor_proposals(submaps, rings, poses, options);
    proposals.insert(proposals.end(), alike.begin(), alike.end());
  }
  return without_repeats(std::move(proposals));
}

/// Pairs of a later round: by the corrected poses, of submaps without a loop, but for pairs that were tried.
std::vector<LoopProposal> further_proposals(std::span<const Submap> submaps, const LoopClosure& closure,
                                            const LoopOptions& options) {
  std::set<std::size_t> closed;
  std::set<std::pair<std::size_t, std::size_t>> tried;
  for (const LoopCandidate& c : closure.candidates) {
    if (c.accepted) closed.insert({c.from, c.to});
    tried.insert({c.from, c.to});
  }
  std::vector<LoopProposal> proposals = pose_proposals(submaps, closure.poses, options, false);
  std::erase_if(proposals, [&](const LoopProposal& p) {
    const std::size_t from = submaps[p.from].center, to = submaps[p.to].center;
    return closed.contains(to) || tried.contains({from, to});
  });
  return without_repeats(std::move(proposals));
}

}  // namespace

const EnumNames<LoopSource>& loop_source_names() {
  static const EnumNames<LoopSource> names{{LoopSource::kPose, "pose"},
                                           {LoopSource::kDescriptor, "descriptor"},
                                           {LoopSource::kCorrected, "corrected poses"}};
  return names;
}

LoopClosure close_loops(std::span<const Keyframe> keyframes, const LoopOptions& options, const Execution& execution) {
  const ExecutionScope scope(execution);
  check_options(options);
  check_keyframes(keyframes);
  const std::vector<double> paths_m = path_lengths_m(keyframes);
  const std::vector<Submap> submaps = submaps_of(keyframes, paths_m, options);
  report_progress("submaps", 0.0);
  const std::vector<SubmapView> views = views_of(submaps, keyframes, options);
  LoopClosure closure;
  closure.n_submaps = submaps.size();
  for (const Keyframe& keyframe : keyframes) closure.poses.push_back(keyframe.T_world_body);
  for (int round = 1; round <= options.rounds; ++round) {
    report_progress("loops", 0.1 + 0.9 * (round - 1) / options.rounds);
    const std::vector<LoopProposal> proposals = round == 1 ? first_proposals(submaps, views, closure.poses, options)
                                                           : further_proposals(submaps, closure, options);
    if (proposals.empty()) break;
    std::vector<LoopCandidate> found = checked(proposals, {keyframes, submaps, views, closure.poses}, options);
    for (LoopCandidate& candidate : found) {
      candidate.round = round;
      closure.candidates.push_back(std::move(candidate));
    }
    reject_contradicted(closure.candidates, keyframes, paths_m, options);
    close_graph(keyframes, options, closure);
    if (closure.n_loops == 0) break;
  }
  report_progress("loops", 1.0);
  return closure;
}

}  // namespace cmap
