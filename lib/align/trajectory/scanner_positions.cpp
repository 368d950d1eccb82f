// Where the scanner of a capture was.

#include <fmt/format.h>

#include "cmap/align/trajectory.hpp"
#include "cmap/core/error.hpp"

namespace cmap {

std::string times_of_scans_and_poses(const Capture& capture, double max_gap_s) {
  return fmt::format("scans from {:.3f} to {:.3f} s, poses from {:.3f} to {:.3f} s, gaps of at most {:g} s",
                     capture.scans.front().time_s, capture.scans.back().time_s, capture.lio.front().time_s,
                     capture.lio.back().time_s, max_gap_s);
}

std::vector<Eigen::Vector3d> scanner_positions(const Capture& capture, double max_gap_s) {
  std::vector<Eigen::Vector3d> positions;
  for (const StampedFile& scan : capture.scans) {
    const auto pose = pose_at(capture.lio, scan.time_s, max_gap_s);
    if (pose) positions.push_back(pose->position + pose->rotation * capture.calibration.T_imu_lidar.translation());
  }
  if (!positions.empty()) return positions;
  if (capture.lio.empty() || capture.scans.empty()) {
    throw InputError(fmt::format("{}: scans and LiDAR-inertial poses (lio.tum) are needed", capture.folder.string()));
  }
  throw InputError(fmt::format("{}: no scan has a LiDAR-inertial pose (lio.tum) at its time: {}",
                               capture.folder.string(), times_of_scans_and_poses(capture, max_gap_s)));
}

}  // namespace cmap
