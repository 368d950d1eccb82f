#pragma once

#include <span>

#include "cmap/sim/camera_view.hpp"
#include "cmap/sim/path.hpp"
#include "cmap/sim/scene.hpp"

namespace cmap {

/// Four panels: the scene from `from_z_m` above down with the way in red, a picture, its depth (near is bright), a scan
/// (points about the LiDAR, axes of the world) from above (bright: high).
RgbImage capture_preview(const Scene& scene, const PoseSpline& path, double from_z_m, const CameraView& view,
                         std::span<const Eigen::Vector3f> scan);

}  // namespace cmap
