#pragma once

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "cmap/core/warning.hpp"
#include "cmap/geometry/trajectory.hpp"
#include "cmap/io/output_file.hpp"

namespace cmap {

/// A trajectory as a file gave it.
struct TrajectoryFile {
  Trajectory poses;               ///< at least one
  bool has_times = true;          ///< false: the file holds none, and time_s is the index of the row
  std::size_t rows = 0;           ///< of poses in the file, those left out too
  std::vector<Warning> warnings;  ///< each names the file
  Trajectory repeated;            ///< left out, as their times were there: by time, else in the file's order
};

/// All poses that have a time, with those of repeated times after the first of theirs.
Trajectory with_repeated(const TrajectoryFile& file);

/// Reads a trajectory in any of these layouts, told apart by what the file holds; one pose a line, separated by blanks,
/// commas or semicolons, `#` comments:
/// - columns named by a header line or a comment: a time (or sec and nsec), a position, a quaternion, in any order,
///   others are passed over (EuRoC's and TUM-VI's csv, ROS's "rostopic echo -p", Newer College's);
/// - 8 numbers: TUM, "time x y z qx qy qz qw"; quaternions of any length are normalized;
/// - 17 numbers: EuRoC's ground truth without its header line (the quaternion is w x y z), or a time and a 4x4 matrix;
/// - 12 or 16 numbers: KITTI, VGGT-Long's camera_poses.txt; the rows of T_world_body, without times. 13: a time and 12;
/// - COLMAP's and Open3D's .log of a camera's poses, without times.
/// Times that can only be milli-, micro- or nanoseconds since 1970, or are so named, become seconds. Rotations of
/// matrices are projected to SO(3). Rows that are not finite or whose quaternion is zero (lost tracking) are left out,
/// as is every pose but the first of one time; unordered rows are sorted; poses exactly at zero without rotation
/// between others stay: all with a warning. Throws InputError naming file, line and reason: another number of columns,
/// what is no number, commas that may be decimal ones, no rotation (beyond 1e-3), no pose, files that are something
/// else. Thread-safe.
TrajectoryFile read_trajectory(const std::filesystem::path& path);

/// Whether a file on disk holds a trajectory and no point cloud, by its first rows: columns named as a time, a position
/// and a quaternion; rows of TUM's layout with times that rise and unit quaternions that are no normals; matrices.
/// Never throws: what cannot be read is none.
bool holds_poses(const std::filesystem::path& path);

/// Two trajectories to be paired by time. `times`, a file with one time a line for each pose, are those of whichever
/// holds none. Where neither does and none are given, both must have as many rows: they are paired row by row, with a
/// warning in the first. Throws as read_trajectory(), InputError for another number of times than poses or where times
/// are missing, UsageError where `times` are given and both have their own.
std::pair<TrajectoryFile, TrajectoryFile> read_trajectory_pair(const std::filesystem::path& first,
                                                               const std::filesystem::path& second,
                                                               const std::optional<std::filesystem::path>& times);

/// Writes a TUM file whose numbers read back as they were. The file appears under its name only when complete. Throws
/// OutputError if it cannot be written.
void write_tum_trajectory(const Trajectory& trajectory, const std::filesystem::path& path);

/// The same into a file that the caller commits.
void write_tum_trajectory(const Trajectory& trajectory, OutputFile& file);

}  // namespace cmap
