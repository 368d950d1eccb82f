#pragma once

#include <Eigen/Geometry>
#include <span>

#include "cmap/geometry/camera_model.hpp"
#include "cmap/sim/scene.hpp"

namespace cmap {

struct SeenSurfaceOptions {
  double points_per_m2 = 100.0;    ///< > 0
  double max_distance_m = 1000.0;  ///< from the camera; farther surfaces count as unseen; > 0
  std::uint64_t seed = 1;
};

/// The points of sample_surface() that at least one of the views shows: inside the image, within the distance, and with
/// nothing in between from the camera to 1 cm before the point (the 1 cm is for the point's own surface, seen at a
/// grazing angle). In the order of sample_surface(). Throws UsageError naming an option outside of its range.
PointCloud seen_surface(const Scene& scene, const CameraModel& camera,
                        std::span<const Eigen::Isometry3d> T_world_camera, const SeenSurfaceOptions& options = {});

}  // namespace cmap
