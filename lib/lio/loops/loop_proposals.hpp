#pragma once

#include <span>
#include <vector>

#include "cmap/lio/loop_closure.hpp"
#include "loops/ring_descriptor.hpp"
#include "loops/submaps.hpp"

namespace cmap {

/// A pair of submaps, by their places in the list, that is to be aligned.
struct LoopProposal {
  std::size_t from = 0, to = 0;  ///< from < to
  LoopSource source = LoopSource::kPose;
};

/// Pairs whose centers are within revisit_m of each other, or may be as odometry drifts: of each submap the
/// `pose_candidates` nearest earlier ones, no two of them neighbors along the path. `poses` are those of all keyframes.
/// With `bounded` false they are taken as right: revisit_m alone counts.
std::vector<LoopProposal> pose_proposals(std::span<const Submap> submaps, std::span<const Eigen::Isometry3d> poses,
                                         const LoopOptions& options, bool bounded = true);

/// Pairs that look alike: of each submap the `descriptor_candidates` most similar earlier ones, no two of them
/// neighbors along the path. Descriptors by submap.
std::vector<LoopProposal> descriptor_proposals(std::span<const Submap> submaps,
                                               std::span<const RingDescriptor> descriptors,
                                               std::span<const Eigen::Isometry3d> poses, const LoopOptions& options);

/// Sorted by to, from; of equal pairs the first stays.
std::vector<LoopProposal> without_repeats(std::vector<LoopProposal> proposals);

}  // namespace cmap
