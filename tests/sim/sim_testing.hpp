#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>
#include <string>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/camera_model.hpp"
#include "cmap/sim/scene.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {

/// Uniform in [low, high), the same with every standard library.
inline double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

/// An axis-aligned box as OBJ text, outward faces, vertices of one color.
inline std::string box_obj(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const char* color = "0.5 0.5 0.5") {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += fmt::format("v {:.17g} {:.17g} {:.17g} {}\n", (i & 1) ? high.x() : low.x(), (i & 2) ? high.y() : low.y(),
                        (i & 4) ? high.z() : low.z(), color);
  }
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

/// Looking along `forward`, the image's top up.
inline Eigen::Isometry3d looking(const Eigen::Vector3d& from, const Eigen::Vector3d& forward) {
  const Eigen::Vector3d z = forward.normalized(), x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << x, z.cross(x), z;
  pose.translation() = from;
  return pose;
}

inline CameraModel pinhole(int width, int height, double focal_px) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal_px;
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

/// The scenes as most tests use them, made once.
inline const Scene& town() {
  static const Scene scene = make_town({});
  return scene;
}
inline const Scene& indoor() {
  static const Scene scene = make_indoor({});
  return scene;
}
inline const Scene& aerial() {
  static const Scene scene = make_aerial({});
  return scene;
}

}  // namespace cmap::testing
