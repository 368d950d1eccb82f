#pragma once

#include <cmath>

#include "cmap/recon/placed_session.hpp"

namespace cmap::test {

inline constexpr int kWidth = 40, kHeight = 30;

/// Depth of a bumpy scene before camera `frame` that moves along x by a meter each: what both sessions see of it.
inline double scene_depth(int u, int v, int frame) {
  return 6.0 + 2.0 * std::sin(0.3 * u + frame) + 1.5 * std::cos(0.4 * v);
}

/// A session of frames first ... first + n - 1, its unit `unit` meters; frame f's camera is at x = f.
inline SessionPredictions session_of(int first, int n, double unit) {
  SessionPredictions session;
  session.width = kWidth;
  session.height = kHeight;
  for (int i = 0; i < n; ++i) {
    session.frames.push_back({static_cast<std::size_t>(i), 0.5 * (first + i), "", kWidth, kHeight});
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation().x() = -i / unit;
    session.T_camera_session.push_back(T);
    session.intrinsics.push_back((Eigen::Matrix3d() << 30, 0, 20, 0, 30, 15, 0, 0, 1).finished());
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        session.depth.push_back(static_cast<float>(scene_depth(u, v, first + i) / unit));
        session.depth_confidence.push_back(3.0f);
        session.images.push_back({100, 100, 100});
      }
    }
  }
  return session;
}

inline Similarity at(double scale, const Eigen::Vector3d& translation, double turn_rad) {
  Similarity T;
  T.scale = scale;
  T.rotation = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  T.translation = translation;
  return T;
}

}  // namespace cmap::test
