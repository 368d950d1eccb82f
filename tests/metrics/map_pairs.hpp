#pragma once

// Pairs of maps for the tests of metrics, what may be done to both without changing a score, and the nearest neighbor
// by its definition.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/color.hpp"
#include "cmap/metrics/map_pair.hpp"
#include "spatial/clouds.hpp"

namespace cmap::test {

struct Clouds {
  PointCloud reference;
  PointCloud estimate;

  MapPair pair() const {
    MapPair pair{IndexedMap(reference), IndexedMap(estimate), {}, {}};
    pair.nearest_in_reference = find_nearest(pair.reference.index, pair.estimate.index.points);
    pair.nearest_in_estimate = find_nearest(pair.estimate.index, pair.reference.index.points);
    return pair;
  }
};

/// Two samplings of one surface about 0.3 m apart, with outliers and random colors; no ties, no duplicates.
inline Clouds two_sheets(std::size_t n_reference = 4000, std::size_t n_estimate = 3000) {
  Clouds clouds{sheet_cloud(n_reference, 1), sheet_cloud(n_estimate, 2)};
  paint(clouds.reference, 3);
  paint(clouds.estimate, 4);
  return clouds;
}

/// A painted cloud in which every point occurs three times, in the same color.
inline PointCloud painted_triplicates(std::size_t n) {
  PointCloud cloud = sheet_cloud(n, 5);
  paint(cloud, 6);
  const auto colors = std::get<Array<Rgb8>>(cloud.colors);
  cloud = repeated(cloud, 3);
  auto& all = std::get<Array<Rgb8>>(cloud.colors);
  for (int copy = 1; copy < 3; ++copy) all.insert(all.end(), colors.begin(), colors.end());
  return cloud;
}

/// A cloud of given points and 8-bit colors.
inline PointCloud cloud_of(std::vector<Eigen::Vector3f> positions, std::vector<Rgb8> colors = {}) {
  PointCloud cloud;
  cloud.positions.assign(positions.begin(), positions.end());
  if (!colors.empty()) cloud.colors = Array<Rgb8>(colors.begin(), colors.end());
  return cloud;
}

inline Eigen::Matrix4d translation(const Eigen::Vector3d& shift_m) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topRightCorner<3, 1>() = shift_m;
  return T;
}

/// A rotation about no axis of the frame, and a shift.
inline Eigen::Matrix4d rigid_motion() {
  Eigen::Matrix4d T = translation({12.5, -7.25, 3.0});
  T.topLeftCorner<3, 3>() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  return T;
}

inline Eigen::Matrix4d scaling(double factor) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() *= factor;
  return T;
}

/// Both maps moved by T, on a common origin as an evaluation prepares them.
inline Clouds moved(const Clouds& clouds, const Eigen::Matrix4d& T) {
  Clouds result{transformed(clouds.reference, T), transformed(clouds.estimate, T)};
  const Eigen::Vector3d shift = result.estimate.origin - result.reference.origin;
  for (Eigen::Vector3f& p : result.estimate.positions) p = (p.cast<double>() + shift).cast<float>();
  result.estimate.origin = result.reference.origin;
  return result;
}

/// The points in another order.
inline PointCloud permuted(const PointCloud& cloud, unsigned seed) {
  std::vector<std::size_t> order(cloud.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::mt19937_64 random(seed);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  PointCloud result;
  result.origin = cloud.origin;
  Array<Rgb8> colors;
  for (std::size_t i : order) {
    result.positions.push_back(cloud.positions[i]);
    if (cloud.has_color()) colors.push_back(std::get<Array<Rgb8>>(cloud.colors)[i]);
  }
  if (cloud.has_color()) result.colors = colors;
  return result;
}

inline Clouds permuted(const Clouds& clouds) { return {permuted(clouds.reference, 7), permuted(clouds.estimate, 8)}; }

/// The points of both clouds, in 8-bit colors.
inline PointCloud appended(PointCloud cloud, const PointCloud& more) {
  cloud.positions.insert(cloud.positions.end(), more.positions.begin(), more.positions.end());
  auto& colors = std::get<Array<Rgb8>>(cloud.colors);
  const auto& more_colors = std::get<Array<Rgb8>>(more.colors);
  colors.insert(colors.end(), more_colors.begin(), more_colors.end());
  return cloud;
}

/// Color of a point, RGB in [0,1].
inline Eigen::Vector3d unit_color(const PointCloud& cloud, std::size_t i) {
  const RgbF c = rgb_255(cloud.colors, i);
  return Eigen::Vector3d(c[0], c[1], c[2]) / 255.0;
}

/// A point's nearest neighbor by the definition: the lowest index among the nearest.
struct Nearest {
  std::size_t index = 0;
  double distance_m = INFINITY;
};

inline std::vector<Nearest> nearest_by_definition(const PointCloud& from, const PointCloud& to) {
  std::vector<Nearest> nearest(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    for (std::size_t j = 0; j < to.size(); ++j) {
      const double distance_m = (from.world(i) - to.world(j)).norm();
      if (distance_m < nearest[i].distance_m) nearest[i] = {j, distance_m};
    }
  }
  return nearest;
}

/// The order of summation, or of the same points along the curve, may change a sum of n terms by a few n 2^-53 at most.
inline constexpr double kSummation = 1e-12;

/// A coordinate below 128 m is rounded to 4e-6 m when a map is moved: 2e-5 of distances of 0.3 m.
inline constexpr double kMoved = 2e-5;

#define EXPECT_NEAR_RELATIVE(actual, expected, tolerance) \
  EXPECT_NEAR(actual, expected, (tolerance)*std::abs(static_cast<double>(expected)))

}  // namespace cmap::test
