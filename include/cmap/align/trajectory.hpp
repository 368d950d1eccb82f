#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cmap/align/alignment.hpp"
#include "cmap/align/pose_pairs.hpp"
#include "cmap/align/time_offset.hpp"
#include "cmap/align/trajectory_fit.hpp"
#include "cmap/align/umeyama.hpp"
#include "cmap/geometry/similarity.hpp"
#include "cmap/io/capture.hpp"
#include "cmap/io/trajectory_file.hpp"

namespace cmap {

/// For messages, of a capture that has scans and poses: "scans from 1 to 2 s, poses from 3 to 4 s, gaps of at most 0.15
/// s".
std::string times_of_scans_and_poses(const Capture& capture, double max_gap_s);

/// Where the scanner of a capture was at the time of each scan that has a pose. Throws InputError where none has.
std::vector<Eigen::Vector3d> scanner_positions(const Capture& capture, double max_gap_s = 0.15);

/// Umeyama's fit (see umeyama.hpp) on the positions of paired poses.
Similarity fit_centers(std::span<const PosePair> pairs, const ScaleModel& model);

struct TrajectoryOptions {
  TrajectoryFit fit = TrajectoryFit::kSim3;
  TimePairing pairing = TimePairing::kInterpolated;
  double max_gap_s = 0.15;         ///< kInterpolated: poses farther apart are not interpolated between
  double max_difference_s = 0.01;  ///< kNearest: poses farther apart are no pair
  double time_offset_s = 0.0;      ///< added to the source's times
  bool find_time_offset = false;   ///< and added, in place of time_offset_s; else one that is found is told
};

/// The absolute trajectory error: RMSE of the positions of all pairs after the plain fit to all of them, as evo has it.
struct TrajectoryError {
  TimePairing pairing = TimePairing::kInterpolated;
  std::size_t n_pairs = 0;
  double rmse_m = 0.0;
};

struct TrajectoryAlignment : Alignment {
  std::vector<TrajectoryError> errors;  ///< by the pairing that was asked for, then by the other, where it has a fit
  std::vector<double> misfit_times_s;   ///< of poses that do not fit and were left out; by the source's clock
  double time_offset_s = 0.0;           ///< that was added to the source's times
  /// The one that was asked for; or, where it was not, one that differs from what was added and leaves less than 70 %
  /// of the RMSE.
  std::optional<TimeOffset> found_time_offset;
};

/// T_dst_src between the worlds of two trajectories of one body, whose times must not fall (see TrajectoryFile for
/// times that repeat). Poses that jump are left out of the fit and named (unless the fit is first-frame); RMSE is over
/// the pairs that fit, n_matches their number; overlap is the share of the source's poses that have a target pose. The
/// judgment is by position: see docs/cmap_align.md. Throws UnsupportedError where times do not meet, where the path
/// leaves a direction free (straight paths: the rotation about them), saying which, and where a time offset is asked
/// for and none is found, saying why.
TrajectoryAlignment align_trajectories(const Trajectory& source, const Trajectory& target,
                                       const TrajectoryOptions& options);

}  // namespace cmap
