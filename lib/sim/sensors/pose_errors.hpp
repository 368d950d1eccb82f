#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "cmap/sim/predictions.hpp"

namespace cmap {

/// Poses T_first_camera (m) of a session's frames with the errors of simulate_session(), from the true ones
/// (T_world_camera). The first is the identity.
std::vector<Eigen::Isometry3d> with_pose_errors(const std::vector<Eigen::Isometry3d>& T_world_camera,
                                                std::size_t session, double stretch, const PredictionOptions& options,
                                                std::uint64_t seed);

}  // namespace cmap
