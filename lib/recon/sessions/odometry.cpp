#include "sessions/odometry.hpp"

namespace cmap {

OdometryPoses odometry_poses(const Capture& capture, std::span<const double> times_s,
                             const SessionInputOptions& options) {
  const CameraMount mount{capture.calibration.T_imu_lidar, capture.calibration.T_lidar_camera};
  return camera_poses(capture.lio, mount, times_s, options.pairing, options.max_gap_s);
}

}  // namespace cmap
