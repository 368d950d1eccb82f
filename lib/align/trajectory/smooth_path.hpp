#pragma once

#include <optional>
#include <vector>

#include "cmap/geometry/trajectory.hpp"

namespace cmap {

/// Positions and rotations between the poses of a trajectory, smooth enough for a derivative by time.
class SmoothPath {
 public:
  /// Times must rise. Poses farther apart than max_gap_s are not interpolated between.
  SmoothPath(const Trajectory& trajectory, double max_gap_s);

  /// A cubic through the poses, whose slope at each is that of the chord between its neighbors.
  std::optional<Eigen::Vector3d> position(double time_s) const;
  std::optional<Eigen::Quaterniond> rotation(double time_s) const;

 private:
  /// Index of the pose at or before the time.
  std::optional<std::size_t> segment(double time_s) const;

  const Trajectory* trajectory_;
  double max_gap_s_;
  std::vector<Eigen::Vector3d> slopes_;  ///< m/s
};

/// Median time between two poses; 0 for fewer than two.
double median_step_s(const Trajectory& trajectory);

}  // namespace cmap
