#pragma once

#include <span>
#include <vector>

#include "cmap/graph/pose_graph.hpp"
#include "cmap/lio/loop_closure.hpp"

namespace cmap {

/// The graph of all keyframes: odometry's motions between neighbors, whose variance grows with the path; roll and pitch
/// of each, where gravity tells them, heading and position left free; the accepted candidates as loops. The first
/// keyframe stays.
PoseGraph loop_graph(std::span<const Keyframe> keyframes, std::span<const LoopCandidate> candidates,
                     const LoopOptions& options);

/// Closes the loops: into `closure`, poses, costs, residuals, and which candidates are dropped as the result
/// contradicts them. Loops pull with ever narrower Cauchy kernels, so that odometry's drift does not make outliers of
/// all of them at the start. Without accepted candidates the poses are odometry's.
void close_graph(std::span<const Keyframe> keyframes, const LoopOptions& options, LoopClosure& closure);

}  // namespace cmap
