#pragma once

#include <span>

#include "cmap/io/capture.hpp"
#include "cmap/recon/session_input.hpp"

namespace cmap {

/// Where the capture's LiDAR-inertial odometry has the camera at these times.
OdometryPoses odometry_poses(const Capture& capture, std::span<const double> times_s,
                             const SessionInputOptions& options);

}  // namespace cmap
