#include "cmap/render/camera.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "names.hpp"

namespace cmap {
namespace {

/// Points that decide what a picture shows: enough for percentiles, few enough to sort.
constexpr std::size_t kSample = 100'000;

std::vector<Eigen::Vector3d> sample(const PointBlocks& points) {
  const std::size_t step = std::max<std::size_t>(1, points.size / kSample);
  std::vector<Eigen::Vector3d> sampled;
  for (std::size_t slot = 0; slot < points.size; slot += step) sampled.push_back(points.world(slot));
  return sampled;
}

/// From the target to the camera, unit length.
Eigen::Vector3d from_angles(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * std::numbers::pi / 180.0;
  const double e = elevation_deg * std::numbers::pi / 180.0;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

/// Azimuth of the map's shortest horizontal axis, on the side of -y.
double short_axis_azimuth_deg(const PointBlocks& points, const Box3d& box) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> inside;
  for (const Eigen::Vector3d& p : sample(points)) {
    if ((p.array() < box.min.array()).any() || (p.array() > box.max.array()).any()) continue;
    inside.emplace_back(p.head<2>() - box.min.head<2>());
    mean += inside.back();
  }
  if (inside.size() < 2) return -90.0;
  mean /= static_cast<double>(inside.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : inside) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(scatter);
  Eigen::Vector2d shortest = axes.eigenvectors().col(0);
  if (shortest.y() > 0.0 || (shortest.y() == 0.0 && shortest.x() > 0.0)) shortest = -shortest;
  return std::atan2(shortest.y(), shortest.x()) * 180.0 / std::numbers::pi;
}

Eigen::Vector3d direction_of(View view, const PointBlocks& points, const Box3d& box) {
  switch (view) {
    case View::kTop:
      return Eigen::Vector3d::UnitZ();
    case View::kOblique:
      return from_angles(-60.0, 40.0);
    case View::kFront:
      return -Eigen::Vector3d::UnitY();
    case View::kSide:
      return Eigen::Vector3d::UnitX();
    case View::kFit:
      return from_angles(short_axis_azimuth_deg(points, box), 35.0);
  }
  throw std::invalid_argument("unknown view");
}

/// Rows right, down, forward.
Eigen::Matrix3d axes_of(const Eigen::Vector3d& forward, const Eigen::Vector3d& up) {
  Eigen::Matrix3d axes;
  axes.row(0) = forward.cross(up).normalized();
  axes.row(1) = forward.cross(axes.row(0).transpose());
  axes.row(2) = forward;
  return axes;
}

/// The camera in direction `backward` from the box in whose picture these points just fit.
Camera camera_that_shows(const std::vector<Eigen::Vector3d>& shown, const Eigen::Vector3d& backward, bool from_above,
                         const Box3d& box, double aspect, bool orthographic) {
  constexpr double kRoom = 1.03;
  Camera camera;
  camera.orthographic = orthographic;
  camera.up = from_above ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d axes = axes_of(-backward, camera.up);

  // What the camera has to see, in its own axes about the box's center; the target is the middle of that.
  const Eigen::Vector3d center = 0.5 * (box.min + box.max);
  std::vector<Eigen::Vector3d> seen;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (const Eigen::Vector3d& p : shown) {
    seen.emplace_back(axes * (p - center));
    low = low.cwiseMin(seen.back());
    high = high.cwiseMax(seen.back());
  }
  Eigen::Vector3d middle = 0.5 * (low + high);
  const double smallest = 0.01 * (box.max - box.min).norm();
  const double tangent = std::tan(camera.field_of_view_deg * std::numbers::pi / 360.0);
  const double half_height = std::max({0.5 * (high.y() - low.y()), 0.5 * (high.x() - low.x()) / aspect, smallest});
  camera.view_height_m = 2.0 * kRoom * half_height;
  double distance = 2.0 * (box.max - box.min).norm();
  // In perspective the middle depends on the distance and the distance on the middle: a few rounds settle both.
  for (int round = 0; round < 4 && !orthographic; ++round) {
    distance = 0.0;
    for (const Eigen::Vector3d& p : seen) {
      const Eigen::Vector3d d = p - middle;
      const double reach = std::max({std::abs(d.y()), std::abs(d.x()) / aspect, smallest});
      distance = std::max(distance, kRoom * reach / tangent - d.z());
    }
    Eigen::Vector2d least = Eigen::Vector2d::Constant(INFINITY), most = -least;
    for (const Eigen::Vector3d& p : seen) {
      const Eigen::Vector2d at = (p - middle).head<2>() / (distance + p.z() - middle.z());
      least = least.cwiseMin(at);
      most = most.cwiseMax(at);
    }
    middle.head<2>() += 0.5 * distance * (least + most);
  }
  camera.target = center + axes.transpose() * middle;
  camera.position = camera.target + distance * backward;
  return camera;
}

}  // namespace

View view_from_name(std::string_view name) {
  return value_of_name<View>("camera", name,
                             {{"top", View::kTop},
                              {"oblique", View::kOblique},
                              {"front", View::kFront},
                              {"side", View::kSide},
                              {"fit", View::kFit}});
}

Box3d box_to_show(const PointBlocks& points) {
  constexpr double kLeftOut = 0.005;  // at either end of every axis
  constexpr double kMargin = 0.02;
  std::vector<Eigen::Vector3d> sampled = sample(points);
  Box3d box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [&](double share) {
      const auto rank = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(sampled.size() - 1)));
      std::nth_element(sampled.begin(), sampled.begin() + rank, sampled.end(),
                       [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
      return sampled[static_cast<std::size_t>(rank)][axis];
    };
    box.min[axis] = at(kLeftOut);
    box.max[axis] = at(1.0 - kLeftOut);
  }
  const double size = (box.max - box.min).norm();
  const double margin = size > 0.0 ? kMargin * size : 0.5;
  return {box.min.array() - margin, box.max.array() + margin};
}

Camera camera_for(View view, const PointBlocks& points, double aspect, bool orthographic) {
  const Box3d box = box_to_show(points);
  std::vector<Eigen::Vector3d> shown = sample(points);
  for (Eigen::Vector3d& p : shown) p = p.cwiseMax(box.min).cwiseMin(box.max);
  return camera_that_shows(shown, direction_of(view, points, box), view == View::kTop, box, aspect, orthographic);
}

Camera turntable_camera_for(View view, const PointBlocks& points, double aspect, bool orthographic) {
  constexpr int kTurns = 24;
  constexpr std::size_t kShown = 4000;
  const Box3d box = box_to_show(points);
  const Eigen::Vector3d center = 0.5 * (box.min + box.max);
  const std::vector<Eigen::Vector3d> sampled = sample(points);
  std::vector<Eigen::Vector3d> shown;
  for (std::size_t i = 0; i < sampled.size(); i += std::max<std::size_t>(1, sampled.size() / kShown)) {
    const Eigen::Vector3d from_center = sampled[i].cwiseMax(box.min).cwiseMin(box.max) - center;
    for (int turn = 0; turn < kTurns; ++turn) {
      const Eigen::AngleAxisd rotation(2.0 * std::numbers::pi * turn / kTurns, Eigen::Vector3d::UnitZ());
      shown.emplace_back(center + rotation * from_center);
    }
  }
  Camera camera =
      camera_that_shows(shown, direction_of(view, points, box), view == View::kTop, box, aspect, orthographic);
  // The turn is about the target: where the line of sight passes the middle of the map, moved onto it.
  const Eigen::Vector3d forward = (camera.target - camera.position).normalized();
  const double level = forward.head<2>().squaredNorm();
  constexpr double kVertical = 1e-12;
  if (level > kVertical) {
    camera.target = camera.position + forward.head<2>().dot((center - camera.position).head<2>()) / level * forward;
  }
  const Eigen::Vector2d aside = (center - camera.target).head<2>();
  camera.target.head<2>() += aside;
  camera.position.head<2>() += aside;
  return camera;
}

Projection::Projection(const Camera& camera, int width, int height)
    : axes(axes_of((camera.target - camera.position).normalized(), camera.up)),
      position(camera.position),
      orthographic(camera.orthographic),
      focal_px(camera.orthographic ? height / camera.view_height_m
                                   : 0.5 * height / std::tan(camera.field_of_view_deg * std::numbers::pi / 360.0)),
      width_px(width),
      height_px(height) {}

}  // namespace cmap
