#pragma once

#include <cstdint>

#include "cmap/core/array.hpp"
#include "cmap/geometry/camera_model.hpp"
#include "cmap/geometry/rgb_image.hpp"

namespace cmap {

/// The camera of the network's input in VGGT's "crop" mode: width W, height H = 14 round(h W / w / 14) (half to even),
/// focal lengths scaled by W / w and H / h, then at most W rows around the middle; the principal point at (W/2, H/2),
/// as VGGT takes it to be, and no distortion: the picture is undistorted and recentered before. Throws UsageError where
/// W is no positive multiple of 14.
CameraModel network_camera(const CameraModel& camera, int width_px = 518);

/// A picture as the network gets it.
struct NetworkImage {
  RgbImage image;
  Array<std::uint8_t> is_shown;  ///< by pixel; 0: the camera's picture ends before
};

/// A camera's picture as network_camera() sees it: each pixel the mean of what the picture shows of the pixel's area,
/// interpolated between the picture's pixels; black where it shows nothing of it. Rows run in parallel; the same for
/// any number of threads. Throws UsageError for a picture that is not of the camera's size.
NetworkImage network_image(const RgbImage& image, const CameraModel& camera, const CameraModel& network);

}  // namespace cmap
