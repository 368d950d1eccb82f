#pragma once

#include "cmap/io/capture.hpp"

namespace cmap {

/// What calib_imu_to_velo.txt, calib_velo_to_cam.txt and calib_cam_to_cam.txt of KITTI's raw data say, beside the drive
/// or in the folder above it: the rectified camera 2 (P_rect_02), its place and that of the IMU. Throws InputError
/// naming file, key and reason.
CaptureCalibration read_kitti_calibration(const std::filesystem::path& drive);

}  // namespace cmap
