#pragma once

#include <cstdint>
#include <vector>

#include "cmap/geometry/trajectory.hpp"
#include "cmap/sim/capture_options.hpp"

namespace cmap {

/// The pose at each time, exact.
Trajectory true_trajectory(const PoseSpline& path, const std::vector<double>& times_s);

/// The same as odometry sees it: position and attitude drift as random walks along the way.
Trajectory with_lio_drift(Trajectory truth, const StatedOptions& options, std::uint64_t seed);

}  // namespace cmap
