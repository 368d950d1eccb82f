#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "cmap/align/trajectory.hpp"

namespace cmap::test {

/// A climbing curve, ten poses a second.
inline Trajectory curve(double from_s, double to_s, double step_s = 0.1) {
  Trajectory trajectory;
  for (double t = from_s; t <= to_s; t += step_s) {
    trajectory.push_back({t,
                          {10 * std::cos(0.3 * t), 10 * std::sin(0.3 * t), std::sin(t)},
                          Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * t, Eigen::Vector3d::UnitZ()))});
  }
  return trajectory;
}

inline Trajectory moved(Trajectory trajectory, const Similarity& T) {
  for (StampedPose& pose : trajectory) {
    pose.position = T * pose.position;
    pose.rotation = Eigen::Quaterniond(T.rotation) * pose.rotation;
  }
  return trajectory;
}

/// Normal noise on every coordinate.
inline Trajectory noisy(Trajectory trajectory, double sigma_m, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, sigma_m);
  for (StampedPose& pose : trajectory) pose.position += Eigen::Vector3d(normal(random), normal(random), normal(random));
  return trajectory;
}

/// Ten poses a second at positions of the time.
template <class Position>
Trajectory along(double to_s, Position&& position) {
  Trajectory trajectory;
  for (int i = 0; i <= static_cast<int>(10.0 * to_s); ++i) {
    trajectory.push_back({0.1 * i, position(0.1 * i), Eigen::Quaterniond::Identity()});
  }
  return trajectory;
}

}  // namespace cmap::test
