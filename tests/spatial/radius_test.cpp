#include "cmap/spatial/radius.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <numeric>

#include "cmap/geometry/color.hpp"
#include "spatial/clouds.hpp"

namespace cmap {
namespace radius_test {

float sq_color_distance(const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return (a - b).squaredNorm(); }

Eigen::Vector3f color(const PointCloud& cloud, std::size_t i) {
  const RgbF c = rgb_255(cloud.colors, i);
  return {c[0], c[1], c[2]};
}

struct ColoredMap {
  explicit ColoredMap(const PointCloud& cloud) : index(sort_points(cloud)), colors(sort_colors(cloud, index.points)) {}
  Bvh index;
  Array<ColorBlock> colors;
};

/// By the queries' own order.
Array<float> most_similar(const PointCloud& data, const PointCloud& queries, const ColorSearch& search) {
  const ColoredMap target(data);
  const ColoredMap query(queries);
  return in_original_order(query.index.points,
                           most_similar_color(target.index, target.colors, query.index.points, query.colors,
                                              find_nearest(target.index, query.index.points), search));
}

void expect_equals_brute_force(const PointCloud& data, const PointCloud& queries, const ColorSearch& search) {
  const Array<float> best = most_similar(data, queries, search);
  ASSERT_EQ(best.size(), queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    float lowest = INFINITY;
    for (std::size_t j = 0; j < data.size(); ++j) {
      if ((queries.world(i) - data.world(j)).squaredNorm() <= search.radius_m * search.radius_m) {
        lowest = std::min(lowest, sq_color_distance(color(queries, i), color(data, j)));
      }
    }
    if (lowest == INFINITY) {
      ASSERT_EQ(best[i], kNoneWithin) << i;
    } else if (lowest > search.stop_at) {
      ASSERT_EQ(best[i], std::min(lowest, search.unless_below)) << i;
    } else {
      ASSERT_GE(best[i], 0.0f) << i;
      ASSERT_LE(best[i], search.stop_at) << i;
    }
  }
}

TEST(MostSimilarColor, EqualsBruteForce) {
  PointCloud data = test::sheet_cloud(3000, 1);
  PointCloud queries = test::sheet_cloud(2000, 2);
  test::paint(data, 3);
  test::paint(queries, 4);
  expect_equals_brute_force(data, queries, {0.5, 0.0f, INFINITY});
  expect_equals_brute_force(data, queries, {0.5, 5852.25f, 5853.0f});
  expect_equals_brute_force(data, queries, {2.0, 500.0f, 1000.0f});
  expect_equals_brute_force(data, queries, {0.02, 0.0f, 20000.0f});
}

TEST(MostSimilarColor, TheRadiusIsInclusiveAndDecidedInDouble) {
  PointCloud data, queries;
  data.positions = {{0, 0, 0}};
  data.colors = Array<Rgb8>{{10, 0, 0}};
  queries.positions = {{0.5f, 0, 0}, {0.50000006f, 0, 0}};  // the float after 0.5
  queries.colors = Array<Rgb8>{{13, 0, 0}, {13, 0, 0}};
  EXPECT_EQ(most_similar(data, queries, {0.5, 0.0f, 100.0f}), (Array<float>{9.0f, kNoneWithin}));
}

TEST(MostSimilarColor, NothingWithinTheRadius) {
  PointCloud cloud = test::uniform_cloud(100, 5);
  test::paint(cloud, 6);
  PointCloud far = cloud;
  far.origin.x() += 1000.0;
  EXPECT_EQ(most_similar(far, cloud, {1.0, 0.0f, INFINITY}), Array<float>(100, kNoneWithin));
}

TEST(NeighborhoodShapes, EqualBruteForce) {
  const PointCloud cloud = test::repeated(test::uniform_cloud(700, 7, 2.0f), 2);
  const Bvh index(sort_points(cloud));
  const NeighborhoodShape shape = neighborhood_shapes(index, 0.4);
  const Array<std::uint32_t> n_neighbors = in_original_order(index.points, shape.n_neighbors);
  const Array<double> dets = in_original_order(index.points, shape.covariance_det);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::vector<Eigen::Vector3d> neighbors;
    for (std::size_t j = 0; j < cloud.size(); ++j) {
      if (j != i && (cloud.world(j) - cloud.world(i)).squaredNorm() <= 0.16) neighbors.push_back(cloud.world(j));
    }
    ASSERT_EQ(n_neighbors[i], neighbors.size());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : neighbors) mean += p / static_cast<double>(neighbors.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const auto& p : neighbors)
      covariance += (p - mean) * (p - mean).transpose() / static_cast<double>(neighbors.size() - 1);
    // Sums relative to the query instead of the mean: no more than a few digits lost of sixteen.
    if (neighbors.size() <= 4) continue;
    ASSERT_NEAR(dets[i], covariance.determinant(), 1e-10 * covariance.diagonal().prod());
  }
}

/// Number of neighbors and bits of the determinant, by the points' own order.
using Shapes = std::vector<std::pair<std::uint32_t, std::uint64_t>>;

Shapes shapes_of(const PointCloud& cloud, double radius_m) {
  const Bvh index(sort_points(cloud));
  const NeighborhoodShape shape = neighborhood_shapes(index, radius_m);
  const Array<std::uint32_t> n_neighbors = in_original_order(index.points, shape.n_neighbors);
  const Array<double> dets = in_original_order(index.points, shape.covariance_det);
  Shapes shapes;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    shapes.emplace_back(n_neighbors[i], std::bit_cast<std::uint64_t>(dets[i]));
  }
  return shapes;
}

TEST(NeighborhoodShapes, NoOrderOfThePointsChangesABit) {
  const PointCloud cloud = test::sheet_cloud(6000, 9, 8.0f);
  for (const double radius_m : {0.3, 1.0, 5.0}) {
    const Shapes expected = shapes_of(cloud, radius_m);
    PointCloud shuffled = cloud;
    std::vector<std::size_t> order(cloud.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::shuffle(order, std::mt19937_64(10));
    for (std::size_t i = 0; i < order.size(); ++i) shuffled.positions[i] = cloud.positions[order[i]];
    const Shapes found = shapes_of(shuffled, radius_m);
    for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(found[i], expected[order[i]]) << radius_m;
  }
}

TEST(NeighborhoodShapes, NoOtherTreeChangesABit) {
  const PointCloud cloud = test::sheet_cloud(6000, 11, 8.0f);
  PointCloud with_far = cloud;  // the points are sorted along another curve
  with_far.positions.push_back({-700, 12, 3});
  with_far.positions.push_back({90, 2000, -5});
  for (const double radius_m : {0.3, 1.0, 5.0}) {
    const Shapes expected = shapes_of(cloud, radius_m);
    Shapes found = shapes_of(with_far, radius_m);
    found.resize(expected.size());
    EXPECT_EQ(found, expected) << radius_m;
  }
}

TEST(NeighborhoodShapes, NoMotionThatKeepsTheOffsetsChangesABit) {
  PointCloud cloud = test::uniform_cloud(3000, 13, 1.0f);
  for (Eigen::Vector3f& p : cloud.positions) p += Eigen::Vector3f(1, 1, 1);  // now multiples of 2^-23
  PointCloud moved = cloud;
  for (Eigen::Vector3f& p : moved.positions) p -= Eigen::Vector3f(1.5f, 1.0f, 1.25f);
  EXPECT_EQ(shapes_of(moved, 0.7), shapes_of(cloud, 0.7));
}

TEST(NeighborhoodShapes, WhatIsCutOffBeyondTheRadiusChangesNoBit) {
  const PointCloud cloud = test::sheet_cloud(6000, 12, 8.0f);
  const double radius_m = 1.0;
  PointCloud part;
  Shapes expected;
  const Shapes shapes = shapes_of(cloud, radius_m);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.positions[i].x() < 2.0f) continue;
    part.positions.push_back(cloud.positions[i]);
    expected.push_back(shapes[i]);
  }
  const Shapes found = shapes_of(part, radius_m);
  std::size_t n_whole = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part.positions[i].x() < 2.0 + radius_m) continue;
    ASSERT_EQ(found[i], expected[i]);
    ++n_whole;
  }
  EXPECT_GT(n_whole, 2000U);
}

TEST(NeighborhoodShapes, ARadiusBeyondTheCloudIsThatOfTheCloud) {
  const PointCloud cloud = test::uniform_cloud(300, 12, 2.0f);
  EXPECT_EQ(shapes_of(cloud, 1e300), shapes_of(cloud, 4.0));
  for (const auto& [n_neighbors, det] : shapes_of(cloud, 1e300)) EXPECT_EQ(n_neighbors, 299U);
  for (const auto& [n_neighbors, det] : shapes_of(test::repeated(cloud, 2), 1e-300)) EXPECT_EQ(n_neighbors, 1U);
}

TEST(NeighborhoodShapes, TooFewNeighborsHaveNoShape) {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}, {0.05f, 0, 0}, {5, 5, 5}};
  const Bvh index(sort_points(cloud));
  const NeighborhoodShape shape = neighborhood_shapes(index, 0.1);
  EXPECT_EQ(in_original_order(index.points, shape.n_neighbors), (Array<std::uint32_t>{1, 1, 0}));
  for (double det : shape.covariance_det) EXPECT_TRUE(std::isnan(det));
  EXPECT_THROW(neighborhood_shapes(index, 0.0), std::invalid_argument);
}

}  // namespace radius_test
}  // namespace cmap
