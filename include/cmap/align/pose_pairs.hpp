#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cmap/align/trajectory_fit.hpp"
#include "cmap/geometry/trajectory.hpp"

namespace cmap {

/// The pose at a time: positions linear, rotations along the shortest arc. None outside the trajectory, or where the
/// two poses around the time are more than max_gap_s apart (a pose at that very time always counts). Thread-safe.
std::optional<StampedPose> pose_at(const Trajectory& trajectory, double time_s, double max_gap_s = 0.15);

/// Poses of two trajectories at the same times.
struct PosePair {
  StampedPose source, target;
};

/// The source's own poses, and the target interpolated there, or its pose within a microsecond. Of poses at one time the
/// first counts.
std::vector<PosePair> pair_in_time(const Trajectory& source, const Trajectory& target, double max_gap_s = 0.15);

/// As evo does (1.38, "nearest_time"): every pose of the trajectory with fewer poses, the source where both have as
/// many, and the pose of the other that is nearest in time and at most max_difference_s away: of two as near the
/// earlier, of several at one time the last. Times may repeat; repeated ones of the shorter trajectory count each.
std::vector<PosePair> pair_nearest(const Trajectory& source, const Trajectory& target, double max_difference_s = 0.01);

/// The first pose of each time.
Trajectory first_of_each_time(const Trajectory& trajectory);

/// With all times later by the offset.
Trajectory shifted_in_time(Trajectory trajectory, double offset_s);

}  // namespace cmap
