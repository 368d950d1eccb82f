#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>

#include "cmap/colorize/surfels.hpp"
#include "cmap/core/array.hpp"
#include "cmap/geometry/camera_model.hpp"

namespace cmap {

/// When a point lies behind a surface. The defaults are for maps of some centimeters; see docs/cmap_colorize.md.
struct OcclusionOptions {
  double tolerance_m = 0.1;          ///< a surface must lie this much nearer to hide a point, and
  double relative_tolerance = 0.01;  ///< this share of the range more
  double thickness_m = 0.06;         ///< and this far from the point's own plane: noise, seen at a flat angle
  double largest_tolerance_m = 1.0;  ///< whatever the angle
  double edge_px = 1.5;              ///< points this near to the image of a nearer edge count as hidden
  double max_range_m = 60.0;         ///< farther points are neither seen nor hide
  int largest_splat_px = 64;         ///< half the width of a disc in the buffer
  int most_pixels = 2'000'000;       ///< of the buffer; larger images get one of fewer, larger pixels
};

/// A disc as one camera has it.
struct ViewPoint {
  std::uint32_t slot = 0;  ///< in the Surfels
  float radius_m = 0.0f;
  Eigen::Vector3f position, normal;  ///< camera frame
  float range_m = 0.0f;
  Eigen::Vector2f pixel;   ///< of the image
  bool is_inside = false;  ///< of the image; those just outside may still hide others
};

/// The discs before a camera: nearer than max_range_m, and on the image or within a tenth of its size around it.
/// T_camera_world is the camera's pose, inverted. Groups of discs out of sight cost nothing. In the order of slots.
Array<ViewPoint> points_in_view(const Surfels& surfels, const CameraModel& camera,
                                const Eigen::Isometry3d& T_camera_world, const OcclusionOptions& options);

/// Ranges of the nearest surfaces before a camera, by ray: a z-buffer of oriented discs.
///
/// Each disc covers the pixels whose rays meet it, at the range where they do (ray and plane; Pfister et al. 2000,
/// "Surfels"), and at least the pixel of its center. A square of one depth would let flat ground hide what lies behind
/// on the same ground. Ranges, not depths: the same for fisheyes. Not thread-safe while it is filled; filled in
/// parallel, the same for any number of threads, as a minimum does not depend on the order.
class DepthBuffer {
 public:
  DepthBuffer(const CameraModel& camera, const OcclusionOptions& options);

  /// In place of what was there.
  void fill(std::span<const ViewPoint> points);

  /// Whether a surface lies nearer on the ray through the point by more than
  ///     max(tolerance_m + relative_tolerance range, min(thickness_m / |cos|, largest_tolerance_m))
  /// with cos that of ray and normal; the range of the point's own plane at the pixel is what that is nearer than, so
  /// that ground does not hide itself. Or within edge_px around it, by what the point's own surface, seen at that
  /// angle (3 degrees less, as normals are not exact), may come nearer more. The point must be inside of the image.
  /// Thread-safe.
  bool hides(const ViewPoint& point) const;

  /// +inf where nothing is.
  float range_m(int x, int y) const { return ranges_[index(x, y)]; }
  int width() const { return camera_.width; }
  int height() const { return camera_.height; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width) + static_cast<std::size_t>(x);
  }
  Eigen::Vector2f buffer_pixel(const Eigen::Vector2f& image_pixel) const;
  void draw(const ViewPoint& point);
  float tolerance_of(const ViewPoint& point, float cosine) const;
  void lower(std::size_t pixel, float range_m);

  OcclusionOptions options_;
  int reduction_ = 1;   ///< image pixels in a buffer's pixel, along an axis
  CameraModel camera_;  ///< of the buffer
  Array<Eigen::Vector3f> rays_;
  Array<float> ranges_;
};

}  // namespace cmap
