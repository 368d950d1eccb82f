#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "cmap/geometry/trajectory.hpp"
#include "filter/nav_state.hpp"

namespace cmap {

/// Where the body was predicted to be over a scan, up to its end, and how an estimate at the end changes that.
///
/// A change of the state at the end reaches back: with tau the time before the end, positions change by
/// dp - tau dv, rotations by theta + tau db (the gyro's bias).
class MotionTrack {
 public:
  MotionTrack() = default;
  /// Poses by increasing time; the last is `predicted`, at the end. Times before the first pose go on backward with
  /// the end's velocity and the first pose's rotation.
  MotionTrack(Trajectory poses, const NavState& predicted) : poses_(std::move(poses)), predicted_(predicted) {}

  double end_s() const { return poses_.back().time_s; }
  const NavState& predicted() const { return predicted_; }
  const Trajectory& poses() const { return poses_; }

  /// The pose at a time up to the end, with `estimate` in place of the prediction there.
  Eigen::Isometry3d pose(double time_s, const NavState& estimate) const;

 private:
  Trajectory poses_;
  NavState predicted_;
};

/// Poses of the LiDAR at even steps over a scan, for its points.
class ScanPoses {
 public:
  /// @param span_s  from the scan's first point to its last
  ScanPoses(const MotionTrack& track, const NavState& estimate, const Eigen::Isometry3d& T_body_lidar, double span_s);

  /// By the time before the scan's end.
  const Eigen::Isometry3d& T_world_lidar(float before_end_s) const {
    const auto step = static_cast<std::size_t>(before_end_s * steps_per_s_ + 0.5f);
    return poses_[step < poses_.size() ? step : poses_.size() - 1];
  }

 private:
  std::vector<Eigen::Isometry3d> poses_;
  float steps_per_s_ = 0.0f;
};

}  // namespace cmap
