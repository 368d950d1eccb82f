#pragma once

#include "cmap/io/capture.hpp"

namespace cmap {

/// Whether a folder is a drive of KITTI's raw data: it has velodyne_points/ and oxts/, and is no capture.
bool is_kitti_drive(const std::filesystem::path& folder);

/// A drive as a capture (FORMATS, "KITTI drives"): scans of velodyne_points/, stamped at the start of their turn,
/// images of the rectified camera 2, the IMU of oxts/, calibration of the three calib_*.txt in the folder or the one
/// above. The poses of oxts/ are GPS' and slide by meters: they are not taken for LiDAR-inertial ones. Throws as
/// open_capture does.
Capture open_kitti_drive(const std::filesystem::path& folder, const CaptureParts& parts, const Faults& faults);

}  // namespace cmap
