#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cmap/align/trajectory.hpp"

namespace cmap {

/// Throws UnsupportedError where there are no pairs, saying why: times apart or in other units, or poses
/// farther apart than the pairing takes, naming the option that takes more.
void require_pairs(const Trajectory& source, const Trajectory& target, std::size_t n_pairs,
                   const TrajectoryOptions& options);

/// Warns of source poses within the target's time that have no pair, as the target's poses around them are too far
/// apart.
void warn_of_gaps(const Trajectory& source, const Trajectory& target, double max_gap_s,
                  std::vector<std::string>& warnings);

}  // namespace cmap
