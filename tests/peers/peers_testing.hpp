#pragma once

// What the tests of other tools' numbers make up.

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "metrics/measured.hpp"

namespace cmap::test {

using Doubles = std::vector<double>;

/// Squares of distances from 0 to 1, most of them small.
inline Doubles peer_squares(std::size_t n) {
  std::mt19937_64 random(1);
  Doubles sq_dist(n);
  for (double& sq : sq_dist) sq = std::pow(uniform(random), 4.0);
  return sq_dist;
}

inline Eigen::Matrix3d diagonal(double a, double b, double c) { return Eigen::Vector3d(a, b, c).asDiagonal(); }

inline const Eigen::Vector3d kZero = Eigen::Vector3d::Zero();

}  // namespace cmap::test
