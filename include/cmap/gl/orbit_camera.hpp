#pragma once

#include "cmap/render/camera.hpp"

namespace cmap {

/// A camera that turns about its target with gravity down: what the mouse does in the viewer.
class OrbitCamera {
 public:
  /// Where this camera is; tilted horizons are set right.
  explicit OrbitCamera(const Camera& start);

  const Camera& camera() const { return camera_; }

  /// Turns about the vertical through the target and raises the camera, up to straight above or below.
  void turn(double azimuth_deg, double elevation_deg);

  /// Moves the camera along the picture so that the target appears this many pixels farther right and down.
  void pan(double right_px, double down_px, int picture_height_px);

  /// What is at the target becomes this much larger.
  void zoom(double factor);

  /// Between perspective and parallel; what is at the target stays as large.
  void toggle_projection();

  /// Looks at this point from the same side and distance.
  void look_at(const Eigen::Vector3d& target);

 private:
  void place();

  Camera camera_;
  double azimuth_deg_, elevation_deg_, distance_m_;  ///< of the camera as seen from the target
  double start_distance_m_;
};

}  // namespace cmap
