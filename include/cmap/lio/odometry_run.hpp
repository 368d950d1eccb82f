#pragma once

#include <string>
#include <vector>

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/geometry/trajectory.hpp"
#include "cmap/lio/keyframe.hpp"
#include "cmap/lio/odometry.hpp"

namespace cmap {

struct KeyframeOptions {
  double step_m = 2.0;     ///< of path: scans until there are one keyframe
  double turn_deg = 30.0;  ///< or of turn
  double voxel_m = 0.1;    ///< its points are thinned to this
};

/// Odometry over a whole recording.
struct OdometryRun {
  Trajectory scan_ends;   ///< world_T_imu at the last point of every scan
  Trajectory imu_stamps;  ///< at the IMU's stamps too; without an IMU the same
  std::vector<Keyframe> keyframes;
  std::vector<OdometryScan> scans;  ///< without points and poses between
  OdometrySummary summary;
};

/// Puts scans together as they come.
class OdometryCollector {
 public:
  explicit OdometryCollector(const KeyframeOptions& options);
  ~OdometryCollector();
  void add(OdometryScan scan);
  OdometryRun finish(const OdometrySummary& summary);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// All keyframes' points at poses of theirs, thinned; no color. `poses` as many as keyframes.
PointCloud keyframe_map(std::span<const Keyframe> keyframes, std::span<const Eigen::Isometry3d> poses, double voxel_m);

}  // namespace cmap
