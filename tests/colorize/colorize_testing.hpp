#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "cmap/colorize/posed_images.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/color.hpp"
#include "cmap/geometry/rotation.hpp"

/// A room of smooth colors that is seen from inside, by formula: its map, and what any camera sees.
namespace cmap::test {

struct PaintedRoom {
  Eigen::Vector3d low{-5, -4, -2}, high{5, 4, 2};

  /// From 0 to 1, with waves of some decimeters.
  static Eigen::Vector3d color(const Eigen::Vector3d& p) {
    const double a = std::sin(5.0 * p.x() + 1.3 * p.z()) * std::cos(4.0 * p.y() - p.x());
    const double b = std::sin(3.0 * p.z() + 2.0 * p.y()) * std::cos(2.3 * p.x() + 0.7 * p.z());
    return {0.5 + 0.3 * a, 0.5 + 0.3 * b, 0.5 + 0.15 * (a + b)};
  }
  Eigen::Vector3d hit(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) const {
    double nearest = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
      const double wall = ray[axis] > 0 ? high[axis] : low[axis];
      if (ray[axis] != 0.0) nearest = std::min(nearest, (wall - from[axis]) / ray[axis]);
    }
    return from + nearest * ray;
  }
  PointCloud map(double spacing_m) const {
    PointCloud cloud;
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (double a = low[u] + 0.5 * spacing_m; a < high[u]; a += spacing_m) {
        for (double b = low[v] + 0.5 * spacing_m; b < high[v]; b += spacing_m) {
          for (const double wall : {low[axis], high[axis]}) {
            Eigen::Vector3f p;
            p[axis] = static_cast<float>(wall);
            p[u] = static_cast<float>(a);
            p[v] = static_cast<float>(b);
            cloud.positions.push_back(p);
          }
        }
      }
    }
    return cloud;
  }
  RgbImage picture(const CameraModel& camera, const Eigen::Isometry3d& T_world_camera, double gain = 1.0) const {
    RgbImage image{camera.width, camera.height, Array<Rgb8>(static_cast<std::size_t>(camera.width * camera.height))};
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector3d ray = T_world_camera.linear() * ray_of(camera, {x, y});
        image.at(x, y) = {0, 0, 0};
        if (!ray.allFinite()) continue;
        image.at(x, y) = to_rgb8((255.0 * gain * color(hit(T_world_camera.translation(), ray))).cast<float>());
      }
    }
    return image;
  }
};

inline CameraModel small_pinhole() { return {CameraProjection::kPinhole, 320, 240, 200, 200, 159.5, 119.5, {}}; }
inline CameraModel small_fisheye() {
  return {CameraProjection::kFisheye, 320, 320, 100, 100, 159.5, 159.5, {0.02, -0.003, 0.0, 0.0}};
}

/// Forward along the LiDAR's x; the camera's z.
inline Eigen::Isometry3d forward_camera() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T.translation() << 0.1, 0.05, -0.08;
  return T;
}

/// A walk through the room that turns about every axis.
inline std::vector<Eigen::Isometry3d> lidar_walk(int n) {
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < n; ++i) {
    const double s = static_cast<double>(i) / n;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() << -2.0 + 3.0 * s, 1.5 * std::sin(4.0 * s), 0.3 * std::cos(7.0 * s);
    T.linear() = rotation_from({0.3 * std::sin(5.0 * s), 0.2 * std::cos(6.0 * s), 6.0 * s});
    poses.push_back(T);
  }
  return poses;
}

/// Pictures of the room along a walk; gains by image, none: 1.
inline PosedImages painted_images(const CameraModel& camera, int n, const std::vector<double>& gains = {}) {
  PosedImages images;
  images.camera = camera;
  images.T_lidar_camera = forward_camera();
  const std::vector<Eigen::Isometry3d> poses = lidar_walk(n);
  auto pictures = std::make_shared<std::vector<RgbImage>>(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    images.list.push_back({i, std::to_string(i), 0.1 * static_cast<double>(i), poses[i]});
  }
  parallel_chunks(poses.size(), 1, [&](std::size_t i, std::size_t) {
    (*pictures)[i] = PaintedRoom().picture(camera, images.T_world_camera(i), gains.empty() ? 1.0 : gains[i]);
  });
  images.read = [pictures](std::size_t place) { return (*pictures)[place]; };
  return images;
}

/// Mean distance of the colors that there are from the truth times a gain, unit RGB.
inline double mean_color_error(const PointCloud& cloud, double gain = 1.0) {
  const auto& colors = std::get<Array<RgbF>>(cloud.colors);
  double sum = 0.0, n = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::isnan(colors[i][0])) continue;
    const Eigen::Vector3d color(colors[i][0], colors[i][1], colors[i][2]);
    sum += (color - gain * PaintedRoom::color(cloud.world(i))).norm();
    n += 1.0;
  }
  return sum / n;
}

}  // namespace cmap::test
