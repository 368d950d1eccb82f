#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "cmap/sim/path.hpp"
#include "cmap/sim/scene.hpp"
#include "scene/scene_builder.hpp"

namespace cmap::testing {

/// A swaying walk around a block, 60 m of it, in about a minute after 2 s of rest.
inline PoseSpline walk(double speed_mps = 1.5) {
  PathOptions options;
  options.rest_s = 2.0;
  options.speed_mps = speed_mps;
  options.sway_position_m = 0.05;
  options.sway_roll_deg = options.sway_pitch_deg = options.sway_yaw_deg = 3.0;
  options.sway_frequency_hz = 0.8;
  return make_path(block_route({-10, -8}, {10, 8}, 1.2, 15.0), options, 1);
}

/// A closed room from (-20,-16,-1) to (20,16,5) with one color per half: every visible point lies on one of six planes.
inline const Eigen::Vector3f kRoomMin{-20.0F, -16.0F, -1.0F}, kRoomMax{20.0F, 16.0F, 5.0F};

inline Scene room() {
  SceneBuilder builder;
  Surface wall;
  wall.base = {0.7F, 0.6F, 0.5F};
  builder.box(wall, kRoomMin, kRoomMax);
  return builder.finish();
}

/// Distance to the nearest of the room's planes.
inline double distance_to_room(const Eigen::Vector3d& p) {
  const Eigen::Array3d below = (p - kRoomMin.cast<double>()).array().abs();
  const Eigen::Array3d above = (p - kRoomMax.cast<double>()).array().abs();
  return below.min(above).minCoeff();
}

inline double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace cmap::testing
