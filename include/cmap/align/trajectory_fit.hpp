#pragma once

#include "cmap/core/enum_names.hpp"

namespace cmap {

/// How trajectories are aligned.
enum class TrajectoryFit {
  kFirstFrame,  ///< T = target pose * (source pose)^-1 of the first pair: exact there, no fit
  kSe3,         ///< Umeyama on positions, scale 1
  kSim3,        ///< Umeyama on positions with scale
};

/// "first-frame", "se3", "sim3".
const EnumNames<TrajectoryFit>& trajectory_fit_names();

/// Which poses of two trajectories belong together; see pose_pairs.hpp.
enum class TimePairing { kInterpolated, kNearest };

/// "interpolated", "nearest".
const EnumNames<TimePairing>& time_pairing_names();

}  // namespace cmap
