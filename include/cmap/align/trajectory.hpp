#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cmap/align/alignment.hpp"
#include "cmap/align/trajectory_fit.hpp"
#include "cmap/align/umeyama.hpp"
#include "cmap/geometry/similarity.hpp"
#include "cmap/io/capture.hpp"
#include "cmap/io/trajectory_file.hpp"

namespace cmap {

/// The pose at a time: positions linear, rotations along the shortest arc. None outside the trajectory, or where the
/// two poses around the time are more than max_gap_s apart (a pose at that very time always counts). Thread-safe.
std::optional<StampedPose> pose_at(const Trajectory& trajectory, double time_s, double max_gap_s = 0.15);

/// For messages, of a capture that has scans and poses: "scans from 1 to 2 s, poses from 3 to 4 s, gaps of at most 0.15
/// s".
std::string times_of_scans_and_poses(const Capture& capture, double max_gap_s);

/// Where the scanner of a capture was at the time of each scan that has a pose. Throws InputError where none has.
std::vector<Eigen::Vector3d> scanner_positions(const Capture& capture, double max_gap_s = 0.15);

/// Poses of two trajectories at the same times: the source's own, and the target interpolated there.
struct PosePair {
  StampedPose source, target;
};
std::vector<PosePair> pair_in_time(const Trajectory& source, const Trajectory& target, double max_gap_s = 0.15);

/// Umeyama's fit (see umeyama.hpp) on the positions of paired poses.
Similarity fit_centers(std::span<const PosePair> pairs, const ScaleModel& model);

/// T_dst_src between the worlds of two trajectories of one body. RMSE is over the positions of all pairs; overlap is
/// the share of the source's poses that have a target pose. Throws UnsupportedError where times do not meet, or where
/// the path leaves a direction free (straight paths: the rotation about them), saying which.
Alignment align_trajectories(const Trajectory& source, const Trajectory& target, TrajectoryFit fit,
                             double max_gap_s = 0.15);

}  // namespace cmap
