#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace cmap {

enum class CameraProjection { kPinhole, kFisheye };

/// A calibrated camera. Camera frame: x right, y down, z forward; pixel centers at integer coordinates (u right, v
/// down). Pinhole distortion is OpenCV's k1 k2 p1 p2 [k3 [k4 k5 k6]] (k4 k5 k6: the denominator of the rational model);
/// fisheye is Kannala and Brandt's k1..k4 as OpenCV writes it, theta_d = theta (1 + k1 theta^2 + ... + k4 theta^8).
/// Empty: none.
///
/// A lens model may fold over: beyond some angle its image turns back toward the center, where no real lens images
/// anything. The camera sees only what lies before the first fold; there project() and ray_of() are inverses.
struct CameraModel {
  CameraProjection projection = CameraProjection::kPinhole;
  int width = 0, height = 0;              ///< pixels
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< pixels
  std::vector<double> distortion;
};

/// Throws UsageError naming field, value and rule: sizes and focal lengths positive, all finite, 0, 4, 5 or 8 numbers
/// of pinhole distortion, 0 or 4 of fisheye. The functions below take a camera that passes.
void check(const CameraModel& camera);

/// Pixel of a point in the camera frame; none behind the camera (pinhole: z <= 0; fisheye: the backward axis itself) or
/// beyond the fold. Not limited to the image: see is_inside. Thread-safe.
std::optional<Eigen::Vector2d> project(const CameraModel& camera, const Eigen::Vector3d& point_camera);

/// Unit direction of the ray through a pixel, in the camera frame, to 1e-9 px of project(); all NaN where no ray leads
/// to that pixel (beyond the fold). Thread-safe.
Eigen::Vector3d ray_of(const CameraModel& camera, const Eigen::Vector2d& pixel);

/// Whether the pixel lies on the image: each pixel reaches half a pixel around its center.
bool is_inside(const CameraModel& camera, const Eigen::Vector2d& pixel);

}  // namespace cmap
