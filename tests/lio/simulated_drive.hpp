#pragma once

// Scenes of a few planes, what a LiDAR and an IMU carried through them record, and odometry over it.

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "cmap/geometry/rotation.hpp"
#include "cmap/lio/odometry.hpp"
#include "cmap/sim/imu.hpp"
#include "cmap/sim/lidar.hpp"
#include "cmap/sim/path.hpp"
#include "cmap/sim/scene.hpp"
#include "scene/scene_builder.hpp"

namespace cmap::test {

inline Surface gray() {
  Surface surface;
  surface.base = {0.6F, 0.6F, 0.6F};
  return surface;
}

/// A closed room from (-20,-16,-1) to (20,16,5), with pillars and boxes about the way of walk_path().
inline Scene furnished_room() {
  SceneBuilder builder;
  builder.box(gray(), {-20, -16, -1}, {20, 16, 5});
  for (const float x : {-14.0F, -3.0F, 5.0F, 15.0F}) {
    builder.box(gray(), {x, -14, -1}, {x + 1.5F, -12, 3});
    builder.box(gray(), {x - 1.0F, 11, -1}, {x + 1.0F, 13.5F, 2});
    builder.box(gray(), {x, -3, -1}, {x + 1.0F, 2, 1.5F});
  }
  return builder.finish();
}

/// One endless wall at y = 4, and nothing else.
inline Scene one_wall() {
  SceneBuilder builder;
  builder.quad(builder.add(gray()), {-200, 4, -50}, {200, 4, -50}, {200, 4, 50}, {-200, 4, 50});
  return builder.finish();
}

/// Around the room's middle, swaying, after a second of rest.
inline PoseSpline walk_path(double speed_mps, double length_m, double sway_deg = 2.0) {
  PathOptions options;
  options.rest_s = 1.0;
  options.ramp_s = 1.0;
  options.speed_mps = speed_mps;
  options.sway_position_m = 0.02;
  options.sway_roll_deg = options.sway_pitch_deg = options.sway_yaw_deg = sway_deg;
  options.sway_frequency_hz = 0.7;
  Route route = block_route({-10, -8}, {10, 8}, 0.6, 15.0);
  double left_m = length_m;
  for (std::size_t i = 1; i < route.size(); ++i) {
    const Eigen::Vector3d step = route[i] - route[i - 1];
    if (step.norm() >= left_m) {
      route[i] = route[i - 1] + left_m * step.normalized();
      route.resize(i + 1);
      break;
    }
    left_m -= step.norm();
  }
  return make_path(route, options, 1);
}

/// 16 lines of 600: ten thousand points.
inline LidarOptions small_spinning() {
  LidarOptions lidar = lidar_model("spinning_16");
  lidar.azimuth_steps = 600;
  return lidar;
}

struct Drive {
  PoseSpline path;
  Eigen::Isometry3d T_imu_lidar = Eigen::Isometry3d::Identity();
  ImuOptions imu_options;
  std::vector<ImuSample> imu;
  std::vector<LidarScan> scans;

  Eigen::Isometry3d truth(double time_s) const { return path.pose(std::clamp(time_s, path.start_s(), path.end_s())); }
};

/// All scans from `from_s` on that end on the path, or so many.
inline Drive drive_through(const Scene& scene, const PoseSpline& path, const LidarOptions& lidar, double from_s = 0.0,
                           std::size_t most = 100000) {
  Drive drive{.path = path, .imu_options = {}, .imu = {}, .scans = {}};
  drive.T_imu_lidar.translation() = Eigen::Vector3d(0.1, -0.05, 0.2);
  drive.T_imu_lidar.linear() = rotation_from({0.02, -0.05, 0.3});
  drive.imu = simulate_imu(path, drive.imu_options, 3);
  for (std::size_t i = 0; i < most; ++i) {
    const double start_s = from_s + static_cast<double>(i) / lidar.scan_rate_hz;
    if (start_s + 1.0 / lidar.scan_rate_hz > path.end_s()) break;
    drive.scans.push_back(simulate_scan(scene, path, drive.T_imu_lidar, lidar, start_s, 5));
  }
  return drive;
}

struct Result {
  std::vector<OdometryScan> scans;
  OdometrySummary summary;
};

/// As they would come: the IMU's samples up to a scan's end before the scan.
inline Result run(const Drive& drive, const OdometryOptions& options,
                  const std::optional<Eigen::Isometry3d>& T_world_start) {
  Result result;
  Odometry odometry(options, drive.T_imu_lidar, T_world_start,
                    [&](OdometryScan&& scan) { result.scans.push_back(std::move(scan)); });
  std::size_t next = 0;
  for (const LidarScan& scan : drive.scans) {
    for (; next < drive.imu.size() && drive.imu[next].time_s < scan.timestamp_s + 0.12; ++next) {
      odometry.add(drive.imu[next]);
    }
    odometry.add(scan);
  }
  for (; next < drive.imu.size(); ++next) odometry.add(drive.imu[next]);
  odometry.finish();
  result.summary = odometry.summary();
  return result;
}

/// From the true pose.
inline Result run(const Drive& drive, const OdometryOptions& options) {
  return run(drive, options, drive.truth(drive.scans.front().timestamp_s));
}

inline double position_error_m(const Drive& drive, const OdometryScan& scan) {
  return (scan.T_world_imu.translation() - drive.truth(scan.time_s).translation()).norm();
}
inline double attitude_error_deg(const Drive& drive, const OdometryScan& scan) {
  return rotation_angle_rad(drive.truth(scan.time_s).linear().transpose() * scan.T_world_imu.linear()) * 180.0 / M_PI;
}

/// The worst of all scans.
inline double worst_position_m(const Drive& drive, const Result& result) {
  double worst = 0.0;
  for (const OdometryScan& scan : result.scans) worst = std::max(worst, position_error_m(drive, scan));
  return worst;
}
inline double worst_attitude_deg(const Drive& drive, const Result& result) {
  double worst = 0.0;
  for (const OdometryScan& scan : result.scans) worst = std::max(worst, attitude_error_deg(drive, scan));
  return worst;
}
inline std::size_t count(const Result& result, ScanOutcome outcome) {
  std::size_t n = 0;
  for (const OdometryScan& scan : result.scans) n += scan.outcome == outcome ? 1 : 0;
  return n;
}

}  // namespace cmap::test
