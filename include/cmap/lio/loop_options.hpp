#pragma once

#include <span>

#include "cmap/lio/keyframe.hpp"

namespace cmap {

/// How loops are looked for, checked and closed. Defaults are for a car or a walk outdoors with a sensor that sees some
/// 60 m; indoor_loop_options() for rooms. Lengths in m, angles in degrees.
struct LoopOptions {
  // Submaps: the keyframes along a stretch of the path, one cloud.
  double submap_m = 30.0;         ///< of path that a submap covers; sparse sensors need more
  double submap_spacing_m = 5.0;  ///< of path between the centers of submaps, above 0
  double voxel_m = 0.4;           ///< submaps are thinned to this; the finest that they are aligned at

  // Candidates: pairs of submaps that may show the same place.
  double revisit_m = 10.0;    ///< centers nearer than this show the same place
  double min_path_m = 60.0;   ///< of path between them; nearer ones are neighbors in time
  double drift_share = 0.01;  ///< odometry may be off by drift_m + drift_share of the path between two poses,
  double drift_m = 2.0;       ///< but by no more than
  double max_drift_m = 50.0;
  double drift_deg = 3.0;  ///< likewise in attitude: drift_deg + drift_deg_per_km of the path, but at most
  double drift_deg_per_km = 5.0;
  double max_drift_deg = 30.0;
  int pose_candidates = 2;        ///< of each submap, by the poses, the nearest first
  int descriptor_candidates = 2;  ///< of each submap, by descriptor, the most similar first; 0: none
  double least_similarity = 0.5;  ///< of descriptors, -1 to 1; less similar ones are no candidates
  double reach_m = 60.0;          ///< of descriptors: points farther from the center do not count
  int rounds = 2;                 ///< candidates are looked for again from the corrected poses

  // Verification: what an aligned pair must show.
  double least_score = 0.45;       ///< share of the common surface that agrees beyond chance, 0 to 1
  double least_places = 25.0;      ///< voxels of surface that agree beyond chance
  double largest_error_m = 0.25;   ///< standard error of the alignment's weakest direction
  double rival_score_share = 0.9;  ///< another pose with this share of the score: ambiguous

  // Pose graph. Standard deviations.
  double odometry_sigma_m_per_sqrt_m = 0.03;  ///< of odometry along a path, as a random walk
  double odometry_sigma_deg_per_sqrt_m = 0.03;
  /// Of roll and pitch of every keyframe, which odometry knows from gravity; 0: it does not (without an IMU).
  double gravity_sigma_deg = 0.3;
  double loop_sigma_m = 0.05;  ///< of a loop, at least
  double loop_sigma_deg = 0.15;
  double cauchy_width = 1.0;      ///< of loops, in standard deviations
  double largest_residual = 5.0;  ///< a loop that the result contradicts by more standard deviations is dropped
};

/// For rooms and halls walked through, where the same is seen again after some meters.
LoopOptions indoor_loop_options();

/// Either, by the ground that the path covers: indoor where its box in x and y has a diagonal below 60 m.
LoopOptions loop_options_for(std::span<const Keyframe> keyframes);

/// Throws UsageError naming the field, its value and the rule it breaks.
void check_options(const LoopOptions& options);

}  // namespace cmap
