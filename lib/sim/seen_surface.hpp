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
  explicit SeenSurface(PointCloud samples) : samples_(std::move(samples)), seen_(samples_.size(), 0) {}

  /// Marks what this view shows: points inside the picture, nearer than max_depth_m, and not behind its depth.
  void look(const CameraModel& camera, const Eigen::Isometry3d& T_world_camera, const Array<float>& depth_m,
            double max_depth_m);

  PointCloud seen() const { return select(samples_, seen_); }

 private:
  PointCloud samples_;
  Array<std::uint8_t> seen_;
};

}  // namespace cmap
