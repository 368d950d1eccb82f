#pragma once

#include <span>
#include <vector>

#include "cmap/lio/loop_closure.hpp"

namespace cmap {

/// Rejects accepted candidates that others contradict: two loops and odometry between their ends are a circle, which
/// must lead back but for the drift of that path (Mangelson et al. 2018). Only loops whose ends are near each other,
/// together three submaps of path, are asked about each other. While one has more against it than for it, the one that
/// has most against it (the lower score, the later) goes. `paths_m` by keyframe.
void reject_contradicted(std::span<LoopCandidate> candidates, std::span<const Keyframe> keyframes,
                         std::span<const double> paths_m, const LoopOptions& options);

}  // namespace cmap
