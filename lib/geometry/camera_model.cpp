#include "cmap/geometry/camera_model.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "cmap/core/error.hpp"
#include "radial_curve.hpp"

namespace cmap {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// OpenCV's pinhole distortion of a point of the plane z = 1.
struct PinholeLens {
  RadialCurve radial;
  double p1 = 0.0, p2 = 0.0;

  explicit PinholeLens(const std::vector<double>& k) {
    if (k.empty()) return;
    radial.numerator = {1.0, k[0], k[1], k.size() > 4 ? k[4] : 0.0, 0.0};
    if (k.size() == 8) radial.denominator = {1.0, k[5], k[6], k[7]};
    p1 = k[2];
    p2 = k[3];
  }
  Vector2d distorted(const Vector2d& p) const {
    const double x = p.x(), y = p.y(), s = p.squaredNorm(), radial_factor = radial.factor(s);
    return {x * radial_factor + 2.0 * p1 * x * y + p2 * (s + 2.0 * x * x),
            y * radial_factor + p1 * (s + 2.0 * y * y) + 2.0 * p2 * x * y};
  }
  Matrix2d jacobian(const Vector2d& p) const {
    const double x = p.x(), y = p.y(), s = p.squaredNorm();
    const double f = radial.factor(s), slope = 2.0 * radial.factor_slope(s);
    const double mixed = x * y * slope + 2.0 * (p1 * x + p2 * y);
    Matrix2d jacobian;
    jacobian << f + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, mixed,  //
        mixed, f + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
    return jacobian;
  }
  bool is_before_fold(const Vector2d& p) const { return radial.rises_to(p.norm()) && jacobian(p).determinant() > 0.0; }
};

/// Newton's method for the point whose image is `target`; none if it does not get there before the fold.
std::optional<Vector2d> undistorted_from(const PinholeLens& lens, const Vector2d& target, Vector2d p) {
  constexpr int kSteps = 30;
  const double enough = 1e-14 * std::max(1.0, target.norm());  // 1e-10 px of a focal length of 10,000
  for (int step = 0; step < kSteps; ++step) {
    const Vector2d error = lens.distorted(p) - target;
    if (error.norm() <= enough) break;
    p -= lens.jacobian(p).inverse() * error;
    if (!p.allFinite()) return std::nullopt;
  }
  // The last steps may have moved between two neighboring floats.
  if (!((lens.distorted(p) - target).norm() <= 10.0 * enough) || !lens.is_before_fold(p)) return std::nullopt;
  return p;
}

std::optional<Vector2d> undistorted(const PinholeLens& lens, const Vector2d& target) {
  if (const auto p = undistorted_from(lens, target, target)) return p;
  const double r_distorted = target.norm();
  const auto r = lens.radial.inverse(r_distorted);
  if (!r) return std::nullopt;
  return undistorted_from(lens, target, target * (*r / r_distorted));
}

RadialCurve fisheye_curve(const std::vector<double>& k) {
  RadialCurve curve;
  std::copy(k.begin(), k.end(), curve.numerator.begin() + 1);
  return curve;
}

Vector2d pixel_of(const CameraModel& camera, const Vector2d& image) {
  return {camera.fx * image.x() + camera.cx, camera.fy * image.y() + camera.cy};
}

Vector3d no_ray() { return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()); }

Vector3d pinhole_ray(const CameraModel& camera, const Vector2d& image) {
  if (camera.distortion.empty()) return image.homogeneous().normalized();
  const auto p = undistorted(PinholeLens(camera.distortion), image);
  return p ? Vector3d(p->homogeneous().normalized()) : no_ray();
}

Vector3d fisheye_ray(const CameraModel& camera, const Vector2d& image) {
  const double distorted = image.norm();
  if (distorted == 0.0) return Vector3d::UnitZ();
  const auto angle = fisheye_curve(camera.distortion).inverse(distorted);
  if (!angle || *angle >= std::numbers::pi) return no_ray();
  const Vector2d side = image * (std::sin(*angle) / distorted);
  return {side.x(), side.y(), std::cos(*angle)};
}

std::optional<Vector2d> project_fisheye(const CameraModel& camera, const Vector3d& point) {
  const double radius = point.head<2>().norm();
  if (radius == 0.0) return point.z() > 0.0 ? std::optional(pixel_of(camera, Vector2d::Zero())) : std::nullopt;
  const double angle = std::atan2(radius, point.z());
  const RadialCurve curve = fisheye_curve(camera.distortion);
  if (!curve.rises_to(angle)) return std::nullopt;
  return pixel_of(camera, point.head<2>() * (angle * curve.factor(angle * angle) / radius));
}

[[noreturn]] void fail(std::string_view field, double value, std::string_view rule) {
  throw UsageError(fmt::format("camera: {} is {:g}; {}", field, value, rule));
}

}  // namespace

void check(const CameraModel& camera) {
  if (camera.width <= 0) fail("width", camera.width, "a positive number of pixels expected");
  if (camera.height <= 0) fail("height", camera.height, "a positive number of pixels expected");
  if (!(camera.fx > 0.0) || !std::isfinite(camera.fx)) fail("fx", camera.fx, "a positive focal length expected");
  if (!(camera.fy > 0.0) || !std::isfinite(camera.fy)) fail("fy", camera.fy, "a positive focal length expected");
  if (!std::isfinite(camera.cx)) fail("cx", camera.cx, "a finite number expected");
  if (!std::isfinite(camera.cy)) fail("cy", camera.cy, "a finite number expected");
  for (const double k : camera.distortion) {
    if (!std::isfinite(k)) fail("a distortion coefficient", k, "a finite number expected");
  }
  const std::size_t n = camera.distortion.size();
  const bool pinhole = camera.projection == CameraProjection::kPinhole;
  if (n != 0 && n != 4 && !(pinhole && (n == 5 || n == 8))) {
    fail("the number of distortion coefficients", static_cast<double>(n),
         pinhole ? "0, 4, 5 or 8 expected of a pinhole" : "0 or 4 expected of a fisheye");
  }
}

std::optional<Vector2d> project(const CameraModel& camera, const Vector3d& point_camera) {
  if (!point_camera.allFinite()) return std::nullopt;
  if (camera.projection == CameraProjection::kFisheye) return project_fisheye(camera, point_camera);
  if (!(point_camera.z() > 0.0)) return std::nullopt;
  const Vector2d p = point_camera.hnormalized();
  if (!p.allFinite()) return std::nullopt;
  if (camera.distortion.empty()) return pixel_of(camera, p);
  const PinholeLens lens(camera.distortion);
  if (!lens.is_before_fold(p)) return std::nullopt;
  return pixel_of(camera, lens.distorted(p));
}

Vector3d ray_of(const CameraModel& camera, const Vector2d& pixel) {
  const Vector2d image((pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy);
  if (!image.allFinite()) return no_ray();
  return camera.projection == CameraProjection::kFisheye ? fisheye_ray(camera, image) : pinhole_ray(camera, image);
}

bool is_inside(const CameraModel& camera, const Vector2d& pixel) {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < camera.width - 0.5 && pixel.y() < camera.height - 0.5;
}

}  // namespace cmap
