#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "cmap/align/verdict.hpp"
#include "cmap/core/enum_names.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/geometry/trajectory.hpp"
#include "cmap/lio/keyframe.hpp"
#include "cmap/lio/loop_options.hpp"

namespace cmap {

/// What made a pair of submaps a candidate.
enum class LoopSource {
  kPose,        ///< the poses, within their drift, are near each other
  kDescriptor,  ///< they look alike from above
  kCorrected,   ///< the poses after the loops of an earlier round
};

/// "pose", "descriptor", "corrected poses".
const EnumNames<LoopSource>& loop_source_names();

/// A pair of submaps that may show one place, and what became of it.
struct LoopCandidate {
  std::size_t from = 0, to = 0;  ///< keyframes at the submaps' centers, from < to
  LoopSource source = LoopSource::kPose;
  int round = 1;
  double path_m = 0.0;            ///< between them
  double pose_distance_m = 0.0;   ///< by the odometry's poses
  double drift_bound_m = 0.0;     ///< what odometry may be off by between them
  double descriptor_score = 0.0;  ///< similarity of their descriptors, -1 to 1
  double yaw_rad = 0.0;           ///< heading of `to` minus that of `from`, as the alignment began with it

  Judgment verdict;                                           ///< of the aligned pair
  double rmse_m = std::numeric_limits<double>::quiet_NaN();   ///< of points that agree, to the planes of the other
                                                              ///< submap; NaN: not aligned
  double inlier_share = 0.0;                                  ///< of the surface that both show, what agrees
  double error_m = std::numeric_limits<double>::quiet_NaN();  ///< standard error of the alignment's weakest direction;
                                                              ///< NaN: not aligned
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();  ///< keyframe `to` in the frame of keyframe `from`
  double correction_m = 0.0;                                    ///< what T_from_to differs from the odometry's poses by
  double correction_deg = 0.0;
  double residual = std::numeric_limits<double>::quiet_NaN();  ///< of the loop in the closed graph, standard
                                                               ///< deviations; NaN: not in it

  bool accepted = false;
  std::string reason;  ///< why it was accepted or not, one sentence without a full stop
};

/// Loops, and the poses that they make of the odometry's.
struct LoopClosure {
  std::vector<LoopCandidate> candidates;  ///< by round, to, from
  std::vector<Eigen::Isometry3d> poses;   ///< T_world_body of every keyframe, corrected; the first stays
  std::size_t n_submaps = 0;
  std::size_t n_loops = 0;        ///< accepted
  double initial_cost = 0.0;      ///< of the graph with its accepted loops at the odometry's poses
  double final_cost = 0.0;        ///< and at `poses`
  double largest_change_m = 0.0;  ///< of a keyframe's position
};

/// Finds places that were seen more than once, aligns what was seen there, and corrects the poses. Candidates are pairs
/// of submaps that the poses, within their drift, or descriptors propose; ICP aligns each, and it becomes a loop where
/// surfaces agree beyond chance, no other pose fits as well, the drift bound holds and other loops do not contradict
/// it. Keyframes come by increasing time. Fewer than two, or none with points, have no loops: `poses` are as they were.
/// Bitwise the same for any number of threads; thread-safe. Throws std::invalid_argument where a pose, time or point is
/// not finite, or times do not increase; UsageError for options.
LoopClosure close_loops(std::span<const Keyframe> keyframes, const LoopOptions& options,
                        const Execution& execution = {});

/// Odometry's poses moved as its keyframes were. Between keyframes k and k + 1 at the share s of their time,
///   T_new = T_after,k Exp(s Log E) T_before,k^-1 T_old,  E = T_after,k^-1 T_after,k+1 T_before,k+1^-1 T_before,k,
/// so that keyframes are met exactly and a correction never acts over a longer lever than to the next keyframe. Earlier
/// poses move as the first keyframe did, later ones as the last. Throws std::invalid_argument where there are no
/// keyframes, the three differ in number, or times do not increase. Thread-safe.
Trajectory corrected(const Trajectory& odometry, std::span<const double> keyframe_times_s,
                     std::span<const Eigen::Isometry3d> before, std::span<const Eigen::Isometry3d> after);

/// loops.json: options, counts, costs, and every candidate with its verdict. What does not apply is null.
nlohmann::ordered_json loops_json(const LoopClosure& closure, std::span<const Keyframe> keyframes,
                                  const LoopOptions& options);

}  // namespace cmap
