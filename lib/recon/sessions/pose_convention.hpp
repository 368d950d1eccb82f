#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cmap/geometry/session_predictions.hpp"
#include "cmap/recon/session_input.hpp"

namespace cmap {

/// What the poses of a file are if not camera-from-world in OpenCV's axes, by the motion between its frames: odometry's
/// (T_world_camera of each frame, where there is one) is found in them only when they are read as camera-to-world, in
/// OpenGL's axes or from the last frame to the first. Lengths do not matter. None: they are right, or it cannot be
/// told.
std::optional<std::string> pose_convention_doubt(const std::vector<Eigen::Isometry3d>& given,
                                                 const OdometryPoses& T_world_camera,
                                                 const PoseConventionOptions& options);

/// Throws InputError where there is such a doubt about a session's poses as its file has them. `name` is the session's.
void require_pose_convention(const std::string& name, const SessionPredictions& session,
                             const OdometryPoses& T_world_camera, const PoseConventionOptions& options);

}  // namespace cmap
