#pragma once

#include <optional>
#include <vector>

#include "cmap/align/pose_pairs.hpp"
#include "cmap/align/umeyama.hpp"
#include "trajectory/smooth_path.hpp"

namespace cmap {

/// How well two trajectories fit, by the offset between their clocks: the poses of the sparser one (at most 2000 of
/// them) against a cubic through the denser one. The trajectories must outlive it.
class OffsetCost {
 public:
  OffsetCost(const Trajectory& source, const Trajectory& target, double max_gap_s);

  /// With the offset added to the source's times; the target's time in both.
  std::vector<PosePair> pairs(double offset_s) const;
  /// Mean squared distance after a fit with scale; infinite where less than 30 % of the poses have a pair, or
  /// these no fit.
  double sq_error_m2(double offset_s) const;
  /// The least of it within reach_s of an offset.
  double refined(double offset_s, double reach_s) const;
  /// From here on without poses that have no pair at this offset, or are farther than so many times the median
  /// distance: what comes and goes with the offset, or jumps, moves its least error. False where there are too few, or
  /// these have no fit.
  bool keep_what_fits(double offset_s, double times_median);
  /// A position of the target, and how the offset moves it against the scaled and turned source, m/s.
  struct Slip {
    Eigen::Vector3d position, velocity;
  };
  /// By differences over reach_s forth and back, where the path is known so far.
  std::vector<Slip> slips(double offset_s, const Similarity& T, double reach_s) const;

 private:
  std::optional<PosePair> pair_of(const StampedPose& anchor, double offset_s) const;

  bool anchors_are_source_;
  Trajectory anchors_;
  std::size_t least_pairs_;
  SmoothPath path_;
};

}  // namespace cmap
