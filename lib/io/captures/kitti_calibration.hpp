#pragma once

#include "cmap/io/capture.hpp"

namespace cmap {

/// What calib_imu_to_velo.txt, calib_velo_to_cam.txt and calib_cam_to_cam.txt of KITTI's raw data say, beside the drive
/// or in the folder above it: camera 2, rectified (P_rect_02), or as it
/// photographs (K_02, D_02) where the drive's name ends in _extract; its place and that of the IMU. Throws InputError
/// naming file, key and reason.
CaptureCalibration read_kitti_calibration(const std::filesystem::path& drive);

}  // namespace cmap
