#pragma once

#include <cstddef>

#include "clouds/row_reader.hpp"
#include "cmap/io/trajectory_file.hpp"
#include "poses/trajectory_layout.hpp"

namespace cmap {

/// The rows of a trajectory's file, as they stand.
struct TrajectoryRows {
  Trajectory poses;  ///< in the file's order, times in the file's unit; without times the index of the row
  bool has_times = true;
  double units_per_s = 0.0;         ///< as the file names it; 0: it does not
  std::size_t n_rows = 0;           ///< with those left out:
  std::size_t n_not_finite = 0;     ///< a number is NaN or infinite
  std::size_t n_zero_rotation = 0;  ///< the quaternion is zero
  bool decimal_comma = false;       ///< commas were taken as decimal ones
  bool assumed_order = false;       ///< no header, and commas as in EuRoC's files: the quaternion may be w x y z
};

/// Reads all rows. Throws InputError (see read_trajectory).
TrajectoryRows read_trajectory_rows(ByteSource& source);

/// Throws InputError naming what the bytes are, where they are known to be something else than rows of poses.
void refuse_other_than_poses(ByteSource& source);

/// The trajectory of a whole source, with the times that it holds.
TrajectoryFile parse_trajectory(ByteSource& source);

}  // namespace cmap
