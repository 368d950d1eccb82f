#pragma once

#include <Eigen/Geometry>

#include "cmap/core/array.hpp"
#include "cmap/geometry/camera_model.hpp"
#include "cmap/geometry/rgb_image.hpp"
#include "cmap/sim/scene.hpp"

namespace cmap {

struct ViewOptions {
  int supersampling = 2;       ///< the image averages supersampling x supersampling rays per pixel; 1 to 8
  double exposure_gain = 1.0;  ///< factor on the colors before they are cut off at white; > 0
  double vignetting = 0.0;     ///< part of the light that is lost in the corners of the image, [0,1); grows as radius^2
};

/// What a camera sees.
struct CameraView {
  RgbImage image;
  Array<float> depth_m;  ///< along the optical axis at pixel centers, row by row; +inf: sky, or no ray at this pixel
};

/// The view of a scene from a pose. Depth is that of the pixel's center, exact to 1e-4 m however distorted the lens;
/// pixels that the lens does not image (fisheye, beyond the fold) are black. Rows of tiles run in parallel; the same
/// for any number of threads. Throws UsageError naming an option or camera field outside of its range.
CameraView render_view(const Scene& scene, const CameraModel& camera, const Eigen::Isometry3d& T_world_camera,
                       const ViewOptions& options = {});

/// Its parts alone.
RgbImage render_image(const Scene& scene, const CameraModel& camera, const Eigen::Isometry3d& T_world_camera,
                      const ViewOptions& options = {});
Array<float> render_depth(const Scene& scene, const CameraModel& camera, const Eigen::Isometry3d& T_world_camera);

}  // namespace cmap
