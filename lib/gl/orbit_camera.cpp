#include "cmap/gl/orbit_camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cmap {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

}  // namespace

OrbitCamera::OrbitCamera(const Camera& start) : camera_(start) {
  const Eigen::Vector3d backward = start.position - start.target;
  distance_m_ = start_distance_m_ = backward.norm();
  elevation_deg_ = std::asin(std::clamp(backward.z() / distance_m_, -1.0, 1.0)) / kDegree;
  // Straight above or below only the picture's up tells where the camera would come down.
  const bool vertical = backward.head<2>().norm() < 1e-9 * distance_m_;
  const Eigen::Vector2d side =
      vertical ? (-std::copysign(1.0, backward.z()) * start.up.head<2>()).eval() : backward.head<2>().eval();
  azimuth_deg_ = std::atan2(side.y(), side.x()) / kDegree;
  place();
}

void OrbitCamera::turn(double azimuth_deg, double elevation_deg) {
  azimuth_deg_ = std::remainder(azimuth_deg_ + azimuth_deg, 360.0);
  elevation_deg_ = std::clamp(elevation_deg_ + elevation_deg, -90.0, 90.0);
  place();
}

void OrbitCamera::pan(double right_px, double down_px, int picture_height_px) {
  const Projection projection(camera_, picture_height_px, picture_height_px);
  const double meters = projection.meters_per_pixel(distance_m_);
  camera_.target -= meters * projection.axes.topRows<2>().transpose() * Eigen::Vector2d(right_px, down_px);
  place();
}

void OrbitCamera::zoom(double factor) {
  distance_m_ /= factor;
  camera_.view_height_m /= factor;
  place();
}

void OrbitCamera::toggle_projection() {
  const double tangent = std::tan(0.5 * camera_.field_of_view_deg * kDegree);
  camera_.orthographic = !camera_.orthographic;
  if (camera_.orthographic) {
    camera_.view_height_m = 2.0 * distance_m_ * tangent;
  } else {
    distance_m_ = 0.5 * camera_.view_height_m / tangent;
  }
  place();
}

void OrbitCamera::look_at(const Eigen::Vector3d& target) {
  camera_.target = target;
  place();
}

void OrbitCamera::place() {
  const double a = azimuth_deg_ * kDegree, e = elevation_deg_ * kDegree;
  const Eigen::Vector3d backward(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
  camera_.up = {-std::sin(e) * std::cos(a), -std::sin(e) * std::sin(a), std::cos(e)};
  // In parallel projection the distance decides only what lies behind the camera: stay away.
  const double distance_m =
      camera_.orthographic ? std::max({distance_m_, start_distance_m_, 2.0 * camera_.view_height_m}) : distance_m_;
  camera_.position = camera_.target + distance_m * backward;
}

}  // namespace cmap
