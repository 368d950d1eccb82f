#pragma once

// A drive through the simulator's town with a spinning LiDAR, and what an odometry that drifts makes of it.

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/lio/keyframe.hpp"
#include "cmap/sim/lidar.hpp"
#include "cmap/sim/path.hpp"
#include "cmap/sim/random_stream.hpp"
#include "cmap/sim/scene.hpp"

namespace cmap::test {

/// Crossings of the town's streets, from the southwest.
using Crossings = std::vector<std::pair<int, int>>;

struct LoopDrive {
  std::vector<Keyframe> keyframes;       ///< by odometry, from the true start
  std::vector<Eigen::Isometry3d> truth;  ///< of each
};

struct LoopDriveOptions {
  TownOptions town;
  Crossings crossings;  ///< where the drive turns; legs along x or y
  double lane_m = 1.6;  ///< right of the streets' center: the way back is on the other side
  double speed_mps = 8.0;
  double keyframe_m = 2.0;
  double voxel_m = 0.2;  ///< keyframes are thinned to this
  LidarOptions lidar = lidar_model("spinning_16");
  // Drift: what odometry's heading, length and slope are off by along the way, smooth over `smooth_m`.
  double heading_deg_per_m = 0.0016;
  double scale = 0.003, slope = 0.002;
  double smooth_m = 150.0;
  std::uint64_t seed = 1;
};

/// Through the crossings in the right lane.
inline Route lane_route(const LoopDriveOptions& o) {
  const auto center = [](int i, int blocks, double pitch_m) { return pitch_m * (i - 0.5 * (blocks - 2)); };
  std::vector<Eigen::Vector2d> corners;
  for (const auto& [i, j] : o.crossings) {
    corners.emplace_back(center(i, o.town.blocks_x, o.town.block_x_m + o.town.street_width_m),
                         center(j, o.town.blocks_y, o.town.block_y_m + o.town.street_width_m));
  }
  const auto right = [&](std::size_t leg) {
    const Eigen::Vector2d d = (corners[leg + 1] - corners[leg]).normalized();
    return Eigen::Vector2d(o.lane_m * d.y(), -o.lane_m * d.x());
  };
  Route route;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    Eigen::Vector2d p = corners[k];
    if (k > 0) p += right(k - 1);
    const bool turns = k == 0 || (k + 1 < corners.size() && (right(k) - right(k - 1)).norm() > 0.1 * o.lane_m);
    if (turns && k + 1 < corners.size()) p += right(k);
    route.emplace_back(p.x(), p.y(), 0.0);
  }
  return route;
}

/// The points of a scan in the body's axes at its start.
inline Array<Eigen::Vector3f> deskewed(const LidarScan& scan, const PoseSpline& path,
                                       const Eigen::Isometry3d& T_imu_lidar, double voxel_m) {
  const Eigen::Isometry3d T_body_world = path.pose(scan.timestamp_s).inverse();
  PointCloud cloud;
  Eigen::Isometry3d T = T_imu_lidar;
  float time_s = -1.0F;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    if (scan.time_s[i] != time_s) {
      time_s = scan.time_s[i];
      T = T_body_world * path.pose(scan.timestamp_s + static_cast<double>(time_s)) * T_imu_lidar;
    }
    cloud.positions.push_back((T * scan.positions[i].cast<double>()).cast<float>());
  }
  return cloud.positions.empty() ? cloud.positions : voxel_thinned(cloud, voxel_m).positions;
}

/// A number that wanders about zero along the way.
class Wander {
 public:
  Wander(double sigma, double smooth_m, std::uint64_t seed, std::uint64_t item)
      : sigma_(sigma), smooth_m_(smooth_m), random_(seed, kRandomLioDrift, item), value_(sigma * random_.normal()) {}
  double after(double step_m) {
    const double kept = std::exp(-step_m / smooth_m_);
    value_ = kept * value_ + std::sqrt(1.0 - kept * kept) * sigma_ * random_.normal();
    return value_;
  }

 private:
  double sigma_, smooth_m_;
  RandomStream random_;
  double value_;
};

/// Poses as odometry has them: heading and length drift, roll and pitch do not.
inline std::vector<Eigen::Isometry3d> drifted(const std::vector<Eigen::Isometry3d>& truth, const LoopDriveOptions& o) {
  Wander turn(o.heading_deg_per_m * std::numbers::pi / 180.0, o.smooth_m, o.seed, 1);
  Wander scale(o.scale, o.smooth_m, o.seed, 2), slope(o.slope, o.smooth_m, o.seed, 3);
  std::vector<Eigen::Isometry3d> poses{truth.front()};
  double heading_rad = 0.0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Eigen::Vector3d step = truth[i].translation() - truth[i - 1].translation();
    heading_rad += turn.after(step.norm()) * step.norm();
    const Eigen::AngleAxisd turned(heading_rad, Eigen::Vector3d::UnitZ());
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = turned * truth[i].linear();
    pose.translation() = poses.back().translation() + (1.0 + scale.after(step.norm())) * (turned * step) +
                         slope.after(step.norm()) * step.norm() * Eigen::Vector3d::UnitZ();
    poses.push_back(pose);
  }
  return poses;
}

inline LoopDrive simulated_drive(const LoopDriveOptions& o) {
  constexpr double kHeight_m = 1.6;
  const Scene scene = make_town(o.town);
  const auto ground = [&](double x, double y) { return scene.ground_height_m(x, y); };
  PathOptions path_options;
  path_options.speed_mps = o.speed_mps;
  path_options.corner_m = 4.0;
  path_options.sway_roll_deg = path_options.sway_pitch_deg = 0.4;
  const PoseSpline path = make_path(draped_route(lane_route(o), ground, kHeight_m), path_options, o.seed);
  Eigen::Isometry3d T_imu_lidar = Eigen::Isometry3d::Identity();
  T_imu_lidar.translation().z() = 0.3;

  LoopDrive drive;
  std::vector<double> times_s;
  const double scan_s = 1.0 / o.lidar.scan_rate_hz;
  for (double t = path.start_s(); t + 2.0 * scan_s < path.end_s(); t += scan_s) {
    const Eigen::Isometry3d T = path.pose(t);
    if (!drive.truth.empty() && (T.translation() - drive.truth.back().translation()).norm() < o.keyframe_m) continue;
    times_s.push_back(t);
    drive.truth.push_back(T);
  }
  const std::vector<Eigen::Isometry3d> poses = drifted(drive.truth, o);
  drive.keyframes.resize(times_s.size());
  parallel_chunks(times_s.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LidarScan scan = simulate_scan(scene, path, T_imu_lidar, o.lidar, times_s[i], o.seed);
      drive.keyframes[i] = {times_s[i], poses[i], deskewed(scan, path, T_imu_lidar, o.voxel_m)};
    }
  });
  return drive;
}

}  // namespace cmap::test
