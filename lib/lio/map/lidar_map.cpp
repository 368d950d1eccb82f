#include "cmap/lio/lidar_map.hpp"

#include <optional>

#include "cmap/align/trajectory.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/io/lidar_scan_file.hpp"

namespace cmap {
namespace {

constexpr std::size_t kScanChunk = 4096;

/// World positions of a scan's points, none where there is no pose.
Array<std::optional<Eigen::Vector3d>> placed(const LidarScan& scan, const Trajectory& world_T_imu,
                                             const Eigen::Isometry3d& T_imu_lidar, const LidarMapOptions& options,
                                             double max_gap_s) {
  Array<std::optional<Eigen::Vector3d>> world(scan.positions.size());
  parallel_chunks(scan.positions.size(), kScanChunk, [&](std::size_t begin, std::size_t end) {
    double time_s = scan.timestamp_s;
    std::optional<StampedPose> pose = pose_at(world_T_imu, time_s, max_gap_s);
    for (std::size_t i = begin; i < end; ++i) {
      const double own_s =
          scan.time_s.empty() ? scan.timestamp_s : scan.timestamp_s + static_cast<double>(scan.time_s[i]);
      if (own_s != time_s) pose = pose_at(world_T_imu, time_s = own_s, max_gap_s);
      const Eigen::Vector3d p = scan.positions[i].cast<double>();
      if (!pose || p.norm() < options.min_range_m) continue;
      world[i] = pose->rotation * (T_imu_lidar * p) + pose->position;
    }
  });
  return world;
}

}  // namespace

void add_deskewed(const LidarScan& scan, const Trajectory& world_T_imu, const Eigen::Isometry3d& T_imu_lidar,
                  const LidarMapOptions& options, double max_gap_s, PointCloud& cloud) {
  for (const std::optional<Eigen::Vector3d>& p : placed(scan, world_T_imu, T_imu_lidar, options, max_gap_s)) {
    if (!p) continue;
    if (cloud.positions.empty()) cloud.origin = choose_origin({*p, *p});
    cloud.positions.push_back((*p - cloud.origin).cast<float>());
  }
}

LidarMap lidar_map(const Capture& capture, double first_s, double last_s, const LidarMapOptions& options,
                   double max_gap_s) {
  LidarMap map;
  for (const StampedFile& file : capture.scans) {
    if (file.time_s < first_s - options.margin_s || file.time_s > last_s + options.margin_s) continue;
    const LidarScan scan = read_lidar_scan(file.path, file.time_s);
    ++map.n_scans;
    map.n_points += scan.positions.size();
    add_deskewed(scan, capture.lio, capture.calibration.T_imu_lidar, options, max_gap_s, map.cloud);
  }
  map.n_placed = map.cloud.size();
  if (map.n_placed > 0) map.cloud = voxel_thinned(map.cloud, options.voxel_m);
  return map;
}

}  // namespace cmap
