#include "cmap/colorize/scan_map.hpp"

#include <fmt/format.h>

#include <optional>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/io/lidar_scan_file.hpp"
#include "cmap/lio/lidar_map.hpp"

namespace cmap {
namespace {

struct Mean {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< from the voxel's center
  std::uint32_t n = 0;
};

/// Means of voxels, around wherever the first point lies.
class GrowingMap {
 public:
  explicit GrowingMap(double voxel_m) : voxel_m_(voxel_m) {}

  void add(const PointCloud& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d p = points.world(i);
      if (!frame_) frame_.emplace(Box3d{p, p}, voxel_m_);
      const VoxelKey key = frame_->key(p);
      Mean& mean = means_[key];
      mean.sum += p - frame_->center(key);
      ++mean.n;
    }
  }

  PointCloud cloud() const {
    PointCloud cloud;
    if (means_.entries().empty()) return cloud;
    Box3d box{position(means_.entries().front()), position(means_.entries().front())};
    for (const auto& entry : means_.entries()) {
      const Eigen::Vector3d p = position(entry);
      box = united(box, {p, p});
    }
    cloud.origin = choose_origin(box);
    cloud.positions.reserve(means_.entries().size());
    for (const auto& entry : means_.entries()) {
      cloud.positions.push_back((position(entry) - cloud.origin).cast<float>());
    }
    return cloud;
  }

 private:
  Eigen::Vector3d position(const VoxelMap<Mean>::Entry& entry) const {
    return frame_->center(entry.key) + entry.value.sum / entry.value.n;
  }

  double voxel_m_;
  std::optional<VoxelFrame> frame_;
  VoxelMap<Mean> means_;
};

}  // namespace

ScanMap map_of_scans(const Capture& capture, const Trajectory& world_T_imu, const ScanMapOptions& options) {
  if (capture.scans.empty()) throw InputError(fmt::format("{}: no LiDAR scans", capture.folder.string()));
  LidarMapOptions placing;
  placing.min_range_m = options.min_range_m;
  ScanMap map;
  GrowingMap growing(options.voxel_m);
  for (const StampedFile& file : capture.scans) {
    report_progress("scans", 0.1 * static_cast<double>(map.n_scans) / static_cast<double>(capture.scans.size()));
    const LidarScan scan = read_lidar_scan(file.path, file.time_s);
    PointCloud placed;
    add_deskewed(scan, world_T_imu, capture.calibration.T_imu_lidar, placing, options.max_gap_s, placed);
    growing.add(placed);
    ++map.n_scans;
    map.n_points += scan.positions.size();
    map.n_placed += placed.size();
  }
  map.cloud = growing.cloud();
  if (map.n_placed == 0) {
    throw InputError(
        fmt::format("{}: no point of its {} scans has a pose at its time", capture.folder.string(), map.n_scans));
  }
  return map;
}

}  // namespace cmap
