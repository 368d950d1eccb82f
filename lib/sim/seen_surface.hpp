#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "cmap/core/camera_model.hpp"
#include "cmap/core/point_cloud.hpp"
#include "cmap/sim/camera_view.hpp"

namespace cmap {

/// Points of a scene's surfaces, and which of them some picture showed.
class SeenSurface {
 public:
  SeenSurface(Scene scene, PointCloud samples)
      : scene_(std::move(scene)), samples_(std::move(samples)), seen_(samples_.size(), 0) {}

  /// Marks what this view shows: points inside the picture, nearer than max_depth_m, with nothing between.
  void look(const CameraModel& camera, const Eigen::Isometry3d& T_world_camera, const Array<float>& depth_m,
            double max_depth_m);

  PointCloud seen() const { return select(samples_, seen_); }

 private:
  /// Whether a ray from the camera reaches the point.
  bool is_reached(const Eigen::Vector3d& camera, const Eigen::Vector3d& point) const;

  Scene scene_;
  PointCloud samples_;
  Array<std::uint8_t> seen_;
};

}  // namespace cmap
