#pragma once

#include <vector>

#include "cmap/io/capture.hpp"
#include "cmap/recon/placed_session.hpp"

namespace cmap {

/// world_T_imu at every frame's time, from the session in which the frame is farthest from an end.
Trajectory trajectory_of(const std::vector<PlacedSession>& sessions, const CaptureCalibration& calibration);

}  // namespace cmap
