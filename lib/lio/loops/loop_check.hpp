#pragma once

#include <span>
#include <vector>

#include "cmap/lio/loop_closure.hpp"
#include "loops/loop_proposals.hpp"
#include "loops/shift_search.hpp"

namespace cmap {

/// What is kept of a submap to propose and start alignments.
struct SubmapView {
  BirdsEye above;
  double ground_m = 0.0;  ///< height of the ground in the level frame
  RingDescriptor ring;
};

/// Everything that pairs are checked with; all by submap but `keyframes`, `poses` by keyframe.
struct LoopInputs {
  std::span<const Keyframe> keyframes;
  std::span<const Submap> submaps;
  std::span<const SubmapView> views;
  std::span<const Eigen::Isometry3d> poses;  ///< those that this round believes in
};

/// Aligns the pairs and says of each whether it is a loop by itself; others are not asked yet. Pairs of one `to` must
/// follow each other. In the order of the proposals.
std::vector<LoopCandidate> checked(std::span<const LoopProposal> proposals, const LoopInputs& inputs,
                                   const LoopOptions& options);

}  // namespace cmap
