#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <vector>

#include "cmap/io/output_file.hpp"

namespace cmap {

/// Where something was at one time: x_world = rotation x_body + position.
struct StampedPose {
  double time_s = 0.0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// Poses by increasing time.
using Trajectory = std::vector<StampedPose>;

/// Reads a TUM file: lines "time x y z qx qy qz qw", separated by blanks or commas, `#` comments; quaternions of any
/// length are normalized. Throws InputError naming file, line and reason: not eight finite numbers, a quaternion of
/// zero, a time that is not after the one before, no pose at all.
Trajectory read_tum_trajectory(const std::filesystem::path& path);

/// Reads KITTI poses, 12 numbers a line: the upper rows of T_world_body, row-major; and their times from a file with
/// one number of seconds a line. Blanks or commas, `#` comments. Rotations are projected to SO(3). Throws InputError
/// naming file, line and reason: another number of numbers, one that is not finite, no rotation (beyond 1e-3), another
/// number of times than poses, times that do not increase, no pose.
Trajectory read_kitti_trajectory(const std::filesystem::path& poses, const std::filesystem::path& times);

/// Reads VGGT-Long's camera_poses.txt, 16 numbers a line: the camera-to-world matrix, row-major, in the unit of the
/// first chunk. Without a file of times, the time of a pose is its index in seconds. Throws InputError likewise.
Trajectory read_camera_poses(const std::filesystem::path& poses,
                             const std::optional<std::filesystem::path>& times = std::nullopt);

/// Writes a TUM file whose numbers read back as they were. The file appears under its name only when complete. Throws
/// UsageError if it cannot be written.
void write_tum_trajectory(const Trajectory& trajectory, const std::filesystem::path& path);

/// The same into a file that the caller commits.
void write_tum_trajectory(const Trajectory& trajectory, OutputFile& file);

}  // namespace cmap
