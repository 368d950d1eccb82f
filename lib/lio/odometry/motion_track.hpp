#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "cmap/geometry/trajectory.hpp"
#include "filter/nav_state.hpp"

namespace cmap {

/// Where the body was predicted to be over a scan, up to its end, and how an estimate at the end changes that.
///
/// By an IMU the motion within the scan is known better than where it takes place: with tau the time before the end, a
/// change of the state at the end changes positions by dp - tau dv and rotations by theta + tau db (the gyro's bias).
/// Without one the pose at the end of the scan before is kept, and a change grows linearly from there to the end:
/// velocity and rate within the scan follow from the two poses alone (otherwise scans that are sheared alike agree with
/// each other, and the shear walks away).
class MotionTrack {
 public:
  /// Poses by increasing time; the last is `predicted`, at the end. Times before the first pose go on backward with
  /// the end's velocity and the first pose's rotation.
  /// @param kept_s  without an IMU, the time of the pose that is kept
  MotionTrack(Trajectory poses, const NavState& predicted, std::optional<double> kept_s)
      : poses_(std::move(poses)), predicted_(predicted), kept_s_(kept_s) {}

  double end_s() const { return poses_.back().time_s; }
  const NavState& predicted() const { return predicted_; }
  const Trajectory& poses() const { return poses_; }

  /// How much of a change of the pose at the end there is at a time before: 0 to 1.
  double share_at(double time_s) const;
  /// The pose at a time up to the end, with `estimate` in place of the prediction there.
  Eigen::Isometry3d pose(double time_s, const NavState& estimate) const;

 private:
  Trajectory poses_;
  NavState predicted_;
  std::optional<double> kept_s_;
};

/// Poses of the LiDAR at even steps over a scan, for its points.
class ScanPoses {
 public:
  /// @param span_s  from the scan's first point to its last
  ScanPoses(const MotionTrack& track, const NavState& estimate, const Eigen::Isometry3d& T_body_lidar, double span_s);

  struct Pose {
    Eigen::Isometry3d T_world_lidar;
    Eigen::Vector3d body_position;  ///< world
    double share;                   ///< MotionTrack::share_at()
  };
  /// By the time before the scan's end.
  const Pose& at(float before_end_s) const {
    const auto step = static_cast<std::size_t>(before_end_s * steps_per_s_ + 0.5f);
    return poses_[step < poses_.size() ? step : poses_.size() - 1];
  }

 private:
  std::vector<Pose> poses_;
  float steps_per_s_ = 0.0f;
};

}  // namespace cmap
