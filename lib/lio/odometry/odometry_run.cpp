#include "cmap/lio/odometry_run.hpp"

#include <algorithm>
#include <numbers>

#include "cmap/core/execution.hpp"
#include "cmap/geometry/rotation.hpp"
#include "cmap/geometry/voxel_map.hpp"

namespace cmap {
namespace {

VoxelKey key_of(const Eigen::Vector3f& p, float per_m) {
  const Eigen::Vector3f place = (p * per_m).array().floor();
  return {static_cast<std::int32_t>(place.x()), static_cast<std::int32_t>(place.y()),
          static_cast<std::int32_t>(place.z())};
}

}  // namespace

struct OdometryCollector::State {
  /// The keyframe that scans are added to.
  struct Growing {
    Keyframe keyframe;
    VoxelMap<bool> seen;
    bool is_open = false;
  };
  KeyframeOptions options;
  OdometryRun run;
  Growing growing;

  void close() {
    if (growing.is_open) run.keyframes.push_back(std::move(growing.keyframe));
    growing = {};
  }
  bool is_far(const Eigen::Isometry3d& T_world_imu) const {
    const Eigen::Isometry3d moved = growing.keyframe.T_world_body.inverse() * T_world_imu;
    return moved.translation().norm() > options.step_m ||
           rotation_angle_rad(moved.linear()) > options.turn_deg * std::numbers::pi / 180.0;
  }
  void add_points(const OdometryScan& scan) {
    const Eigen::Isometry3f T = (growing.keyframe.T_world_body.inverse() * scan.T_world_imu).cast<float>();
    const auto per_m = static_cast<float>(1.0 / options.voxel_m);
    for (const Eigen::Vector3f& p : scan.points) {
      const Eigen::Vector3f in_keyframe = T * p;
      bool& is_seen = growing.seen[key_of(in_keyframe, per_m)];
      if (is_seen) continue;
      is_seen = true;
      growing.keyframe.points_body.push_back(in_keyframe);
    }
  }
};

OdometryCollector::OdometryCollector(const KeyframeOptions& options)
    : state_(std::make_unique<State>(State{options, {}, {}})) {}
OdometryCollector::~OdometryCollector() = default;

void OdometryCollector::add(OdometryScan scan) {
  State& s = *state_;
  s.run.scan_ends.push_back(
      {scan.time_s, scan.T_world_imu.translation(), Eigen::Quaterniond(scan.T_world_imu.linear())});
  s.run.imu_stamps.insert(s.run.imu_stamps.end(), scan.between.begin(), scan.between.end());
  if (!s.growing.is_open || s.is_far(scan.T_world_imu)) {
    s.close();
    s.growing.is_open = true;
    s.growing.keyframe.time_s = scan.time_s;
    s.growing.keyframe.T_world_body = scan.T_world_imu;
  }
  s.add_points(scan);
  scan.points = {};
  scan.between = {};
  s.run.scans.push_back(std::move(scan));
}

OdometryRun OdometryCollector::finish(const OdometrySummary& summary) {
  state_->close();
  state_->run.summary = summary;
  return std::move(state_->run);
}

PointCloud keyframe_map(std::span<const Keyframe> keyframes, std::span<const Eigen::Isometry3d> poses, double voxel_m) {
  PointCloud map;
  if (!poses.empty()) map.origin = choose_origin({poses.front().translation(), poses.front().translation()});
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    throw_if_stopped();
    for (const Eigen::Vector3f& p : keyframes[k].points_body) {
      map.positions.push_back((poses[k] * p.cast<double>() - map.origin).cast<float>());
    }
  }
  return map.positions.empty() ? map : voxel_thinned(map, voxel_m);
}

}  // namespace cmap
