#pragma once

#include <deque>

#include "cmap/lio/odometry.hpp"
#include "filter/propagation.hpp"
#include "map/plane_map.hpp"
#include "odometry/imu_queue.hpp"
#include "odometry/motion_track.hpp"
#include "odometry/scan_points.hpp"
#include "odometry/scan_registration.hpp"

namespace cmap {

/// What an odometry keeps from scan to scan.
struct Odometry::State {
  OdometryOptions options;
  Eigen::Isometry3d T_imu_lidar;
  std::optional<Eigen::Isometry3d> T_world_start;
  Take take;
  MotionNoise noise;

  ImuQueue imu;
  std::deque<ScanPoints> waiting;
  PlaneMap map;
  NavState nav;
  StateMatrix covariance;
  Trajectory track;  ///< the last poses
  bool started = false;
  int n_missed = 0;
  int n_inserted = 0;
  NavState at_insert;  ///< where the last scan went into the map
  double last_end_s = 0.0;
  bool any_scan = false;
  OdometrySummary summary;

  State(const OdometryOptions& o, const Eigen::Isometry3d& T, const std::optional<Eigen::Isometry3d>& start, Take t);

  // Which scan's turn it is: odometry.cpp.
  void add(ScanPoints scan);
  void work(bool to_the_end);
  bool covered(const ScanPoints& scan) const { return !options.use_imu || imu.last_s() >= scan.end_s; }

  // One scan: scan_steps.cpp.
  void begin(bool alone);
  void process(const ScanPoints& scan);
  MotionTrack predict(double to_s, StateMatrix& predicted_covariance) const;
  /// Without an IMU: velocity and rate follow the poses, by a fixed share of what the prediction was off by.
  void follow_motion(const MotionTrack& motion, double duration_s);
  ScanOutcome outcome_of(const ScanRegistration& found);
  bool adds_to_map() const;
  void insert(const ScanPoints& scan, const MotionTrack& track);
  void deliver(const ScanPoints& scan, const MotionTrack& track, OdometryScan result, double cpu_begin_s);
  std::vector<MotionInput> inputs(double from_s, double to_s) const;
};

}  // namespace cmap
