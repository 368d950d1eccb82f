#include "open3d_camera.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "camera_json.hpp"
#include "cmap/core/error.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kOrthographicDeg = 5.0;  ///< the field of view by which its viewer means a parallel projection
constexpr double kLargestDeg = 180.0;

Eigen::Vector3d vector(const Json& object, const char* key) {
  return camera_numbers(key, camera_member(object, key), 3);
}

/// The viewer shows `zoom` times the largest edge of the box on either side of the point it looks at.
Camera camera_from_view(const Json& trajectory) {
  const Json& views = camera_member(trajectory, "trajectory");
  if (!views.is_array() || views.size() != 1) {
    throw UsageError(fmt::format("trajectory: {} views; a picture is of one", views.is_array() ? views.size() : 0));
  }
  const Json& view = views.front();
  const double field_of_view_deg =
      camera_number("field_of_view", camera_member(view, "field_of_view"), 0.0, kLargestDeg);
  const double zoom = camera_number("zoom", camera_member(view, "zoom"), 0.0, kMaxCoordinate_m);
  const Eigen::Vector3d size = vector(view, "boundingbox_max") - vector(view, "boundingbox_min");
  const double half_height_m = zoom * size.maxCoeff();
  Camera camera;
  camera.orthographic = field_of_view_deg == kOrthographicDeg;
  camera.field_of_view_deg = field_of_view_deg;
  camera.view_height_m = 2.0 * half_height_m;
  camera.target = vector(view, "lookat");
  camera.up = vector(view, "up");
  const double distance_m = half_height_m / std::tan(0.5 * field_of_view_deg * std::numbers::pi / 180.0);
  camera.position = camera.target + distance_m * vector(view, "front").normalized();
  return camera;
}

/// Matrices lie in columns; the camera looks along +z, y is down.
Camera camera_from_pinhole(const Json& parameters) {
  const Json& intrinsic = camera_member(parameters, "intrinsic");
  const double width = camera_number("width", camera_member(intrinsic, "width"), 0.0, kMaxCoordinate_m);
  const double height = camera_number("height", camera_member(intrinsic, "height"), 0.0, kMaxCoordinate_m);
  const Eigen::VectorXd k = camera_numbers("intrinsic_matrix", camera_member(intrinsic, "intrinsic_matrix"), 9);
  const double fx = k[0], fy = k[4], cx = k[6], cy = k[7];
  constexpr double kMost_px = 1.0, kMostUneven = 1e-3;
  if (std::abs(cx + 0.5 - 0.5 * width) > kMost_px || std::abs(cy + 0.5 - 0.5 * height) > kMost_px) {
    throw UsageError(fmt::format("intrinsic_matrix: the principal point {}, {} is not in the middle of {} x {} pixels",
                                 cx, cy, width, height));
  }
  if (!(fx > 0.0 && std::abs(fx - fy) <= kMostUneven * fx)) {
    throw UsageError(fmt::format("intrinsic_matrix: focal lengths {} and {} are not of square pixels", fx, fy));
  }
  const Eigen::VectorXd e = camera_numbers("extrinsic", camera_member(parameters, "extrinsic"), 16);
  const Eigen::Matrix4d T_camera_world = Eigen::Map<const Eigen::Matrix4d>(e.data());
  const Eigen::Matrix3d R = T_camera_world.topLeftCorner<3, 3>();
  constexpr double kMostSkew = 1e-3;
  if (!((R * R.transpose()).isIdentity(kMostSkew) && R.determinant() > 0.0)) {
    throw UsageError("extrinsic: holds no rotation");
  }
  Camera camera;
  camera.position = -R.transpose() * T_camera_world.topRightCorner<3, 1>();
  camera.target = camera.position + R.row(2).transpose();
  camera.up = -R.row(1).transpose();
  camera.field_of_view_deg = 2.0 * std::atan(0.5 * height / fy) * 180.0 / std::numbers::pi;
  return camera;
}

}  // namespace

bool is_open3d_camera(const Json& json) {
  const auto name = json.find("class_name");
  return name != json.end() && (*name == "ViewTrajectory" || *name == "PinholeCameraParameters");
}

Camera camera_from_open3d(const Json& json) {
  return json.at("class_name") == "ViewTrajectory" ? camera_from_view(json) : camera_from_pinhole(json);
}

}  // namespace cmap
