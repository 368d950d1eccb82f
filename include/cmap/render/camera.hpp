#pragma once

#include <filesystem>
#include <string_view>

#include "cmap/spatial/point_blocks.hpp"

namespace cmap {

/// Where a picture is taken from. World frame, meters.
struct Camera {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  bool orthographic = false;
  double field_of_view_deg = 35.0;  ///< perspective: between the picture's top and bottom
  double view_height_m = 1.0;       ///< orthographic: what the picture shows from top to bottom
};

/// Standard views of a map with gravity down: from above (north up), from above at an angle, along +y, along -x, and
/// along the map's shortest horizontal axis at an angle.
enum class View { kTop, kOblique, kFront, kSide, kFit };

/// Throws UsageError on an unknown name.
View view_from_name(std::string_view name);

/// The box that a picture of these points should show: the central 99 % along every axis, so that a few outliers do not
/// shrink the map; never flat in all directions, a map of one point gets 1 m.
Box3d box_to_show(const PointBlocks& points);

/// The view in which box_to_show just fits into a picture of this aspect (width / height).
Camera camera_for(View view, const PointBlocks& points, double aspect, bool orthographic);

/// The same for a whole turn about the vertical axis through the target, which is that of the map: it stays in the
/// picture.
Camera turntable_camera_for(View view, const PointBlocks& points, double aspect, bool orthographic);

/// A camera as JSON: position_m, target_m, up, field_of_view_deg or (orthographic) view_height_m; or as Open3D saves
/// one. Throws UsageError that names file and key for unknown keys, wrong types, and a camera that looks nowhere.
Camera read_camera(const std::filesystem::path& path);

/// Camera axes and scale for one picture: a world point p is at pixel (x, y) = center + focal * (right.d, down.d) / w
/// with d = p - position and w = forward.d (perspective) or 1 (orthographic).
struct Projection {
  Projection(const Camera& camera, int width_px, int height_px);

  Eigen::Matrix3d axes;  ///< rows: right, down, forward
  Eigen::Vector3d position;
  bool orthographic;
  double focal_px;  ///< pixels per unit tangent (perspective) or per meter (orthographic)
  int width_px, height_px;

  /// Meters across one pixel at this depth.
  double meters_per_pixel(double depth_m) const { return orthographic ? 1.0 / focal_px : depth_m / focal_px; }
};

}  // namespace cmap
