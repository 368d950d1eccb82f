#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "cmap/core/error.hpp"
#include "cmap/geometry/similarity.hpp"
#include "core/refusal.hpp"
#include "spatial/clouds.hpp"

namespace cmap::test {

inline double uniform_in(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * uniform(random);
}

/// Uniform over all rotations (Shoemake's method).
inline Eigen::Matrix3d random_rotation(std::mt19937_64& random) {
  const double u = uniform(random), a = 2.0 * M_PI * uniform(random), b = 2.0 * M_PI * uniform(random);
  return Eigen::Quaterniond(std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a),
                            std::sqrt(u) * std::sin(b))
      .toRotationMatrix();
}

inline Eigen::Vector3d random_vector(std::mt19937_64& random, double reach) {
  const double x = uniform_in(random, -reach, reach), y = uniform_in(random, -reach, reach);
  return {x, y, uniform_in(random, -reach, reach)};
}

inline Similarity random_similarity(std::mt19937_64& random, double low_scale, double high_scale, double reach_m) {
  const double scale = uniform_in(random, low_scale, high_scale);
  const Eigen::Matrix3d rotation = random_rotation(random);
  return {scale, rotation, random_vector(random, reach_m)};
}

/// The largest displacement between two transforms on the corners of the box of a cloud, m.
inline double displacement_m(const Similarity& a, const Similarity& b, const PointCloud& cloud) {
  return farthest_apart(a, b, corners(bounds(cloud)));
}

inline double angle_between_deg(const Similarity& a, const Similarity& b) {
  return rotation_angle_rad(a.rotation.transpose() * b.rotation) * 180.0 / M_PI;
}

}  // namespace cmap::test
