#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "cmap/geometry/trajectory.hpp"

namespace cmap {

/// How the clocks of two trajectories differ.
struct TimeOffset {
  double offset_s = 0.0;          ///< to be added to the source's times
  double standard_error_s = 0.0;  ///< from the residuals, as far as they are independent of each other
  double rmse_m = 0.0;            ///< of positions that fit, with it
  std::size_t n_pairs = 0;
};

/// The offset, or why there is none.
struct TimeOffsetSearch {
  std::optional<TimeOffset> found;
  std::string reason;  ///< why not
};

/// The offset between the clocks of two trajectories of one body, whatever their times, where they share at least 30 %
/// of the shorter one's duration. Candidates are the peaks of the correlation of speed, turn rate of the body and turn
/// rate of the path, which do not depend on frames and scales; each is refined to the least RMSE of positions after a
/// fit with scale, the sparser trajectory's poses against a cubic through the denser's. None where
/// - motion does not tell: what the offset changes that no similarity undoes is not above noise, as on a straight path
///   at constant speed or on a circle; or the standard error is above 0.05 s;
/// - another candidate fits as well (RMSE within 1.5 times), as of laps;
/// - the paths are not alike (RMSE above half of their spread).
TimeOffsetSearch find_time_offset(const Trajectory& source, const Trajectory& target);

}  // namespace cmap
