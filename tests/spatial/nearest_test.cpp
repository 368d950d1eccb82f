#include "cmap/spatial/nearest.hpp"

#include <gtest/gtest.h>

#include "spatial/clouds.hpp"

namespace cmap {
namespace nearest_test {

/// The definition, point by point: squared distance in double, ties to the lowest index.
NearestNeighbors brute_force(const PointCloud& data, const PointCloud& queries) {
  NearestNeighbors result{Array<std::uint32_t>(queries.size()), Array<double>(queries.size(), INFINITY)};
  for (std::size_t i = 0; i < queries.size(); ++i) {
    for (std::size_t j = 0; j < data.size(); ++j) {
      const Eigen::Vector3d d = queries.positions[i].cast<double>() - data.positions[j].cast<double>();
      const double sq_dist = d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
      if (sq_dist < result.sq_dist[i]) {
        result.sq_dist[i] = sq_dist;
        result.index[i] = static_cast<std::uint32_t>(j);
      }
    }
  }
  return result;
}

void expect_equals_brute_force(const PointCloud& data, const PointCloud& queries) {
  const NearestNeighbors expected = brute_force(data, queries);
  const NearestNeighbors found = nearest_neighbors(data, queries);
  EXPECT_EQ(found.index, expected.index);
  EXPECT_EQ(found.sq_dist, expected.sq_dist);
}

PointCloud cloud_of(std::initializer_list<Eigen::Vector3f> positions) {
  PointCloud cloud;
  cloud.positions.assign(positions.begin(), positions.end());
  return cloud;
}

TEST(Nearest, HandComputed) {
  const PointCloud data = cloud_of({{0, 0, 0}, {1, 0, 0}, {0, 2, 0}});
  const NearestNeighbors found = nearest_neighbors(data, cloud_of({{0.75f, 0, 0}, {0, 3, 0}, {0, 0, -2}}));
  EXPECT_EQ(found.index, (Array<std::uint32_t>{1, 2, 0}));
  EXPECT_EQ(found.sq_dist, (Array<double>{0.0625, 1.0, 4.0}));
}

TEST(Nearest, EqualsBruteForceAtEverySizeAroundBlocksAndNodes) {
  for (std::size_t n : {1, 2, 15, 16, 17, 31, 255, 256, 257, 300, 4095, 4097}) {
    SCOPED_TRACE(n);
    expect_equals_brute_force(test::uniform_cloud(n, 1), test::uniform_cloud(n / 2 + 1, 2));
  }
}

TEST(Nearest, EqualsBruteForceOnSurfacesWithOutliers) {
  expect_equals_brute_force(test::sheet_cloud(6000, 3), test::sheet_cloud(5000, 4));
}

TEST(Nearest, TiesGoToTheLowestIndex) {
  PointCloud queries = test::grid_cloud(12);
  for (Eigen::Vector3f& p : queries.positions) p += Eigen::Vector3f(0.5f, 0.5f, 0.5f);  // eight equally near each
  expect_equals_brute_force(test::grid_cloud(13), queries);
  expect_equals_brute_force(test::repeated(test::grid_cloud(8), 5), queries);
}

TEST(Nearest, DistancesThatFloatCannotTellApartAreDecidedInDouble) {
  // All data on a sphere around the query up to the rounding of their coordinates.
  PointCloud data = test::uniform_cloud(4000, 15, 2.0f);
  for (Eigen::Vector3f& p : data.positions) p = (p - Eigen::Vector3f::Ones()).normalized() + Eigen::Vector3f(5, 6, 7);
  PointCloud queries = test::uniform_cloud(100, 16, 1e-6f);
  for (Eigen::Vector3f& p : queries.positions) p += Eigen::Vector3f(5, 6, 7);
  expect_equals_brute_force(data, queries);
}

TEST(Nearest, DuplicatesByTheThousand) {
  PointCloud same = test::repeated(cloud_of({{1, 2, 3}}), 200000);
  const NearestNeighbors found = nearest_neighbors(same, same);
  EXPECT_EQ(found.index, Array<std::uint32_t>(same.size(), 0u));
  EXPECT_EQ(found.sq_dist, Array<double>(same.size(), 0.0));
  const NearestNeighbors from_afar = nearest_neighbors(same, test::uniform_cloud(100000, 17));
  EXPECT_EQ(from_afar.index, Array<std::uint32_t>(100000, 0u));
  expect_equals_brute_force(test::repeated(test::uniform_cloud(20, 5), 150), test::uniform_cloud(500, 6));
}

TEST(Nearest, CollinearAndPlanar) {
  PointCloud line = test::uniform_cloud(2000, 7);
  for (Eigen::Vector3f& p : line.positions) p = Eigen::Vector3f(p.x(), 0, 0);
  PointCloud plane = test::uniform_cloud(2000, 8);
  for (Eigen::Vector3f& p : plane.positions) p.z() = 1.0f;
  expect_equals_brute_force(line, plane);
  expect_equals_brute_force(plane, line);
}

TEST(Nearest, FarClustersGetCurvesOfTheirOwn) {
  PointCloud data = test::uniform_cloud(5000, 9, 1.0f);
  for (std::size_t i = 0; i < data.size(); i += 2) data.positions[i] += Eigen::Vector3f(1e6f, 0, 0);
  PointCloud queries = test::uniform_cloud(3000, 10, 1.0f);
  expect_equals_brute_force(data, queries);
}

TEST(Nearest, CloudsAMillionMetersApart) {
  PointCloud data = test::uniform_cloud(3000, 11);
  PointCloud queries = test::uniform_cloud(3000, 12);
  queries.origin = {1e6, 0, 0};
  const NearestNeighbors found = nearest_neighbors(data, queries);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    double sq_dist = INFINITY;
    for (const auto& p : data.positions)
      sq_dist = std::min(sq_dist, (queries.world(i) - p.cast<double>()).squaredNorm());
    // Queries are rounded to float a million meters away: 0.0625 m, on a distance of a million.
    ASSERT_NEAR(std::sqrt(found.sq_dist[i]), std::sqrt(sq_dist), 0.1);
  }
}

TEST(Nearest, FlannAgrees) {
  const Bvh data(sort_points(test::sheet_cloud(20000, 13)));
  const PointBlocks queries = sort_points(test::sheet_cloud(20000, 14));
  const NearestField ours = find_nearest(IndexKind::kBvh, data, queries);
  const NearestField flann = find_nearest(IndexKind::kFlann, data, queries);
  for (std::size_t i = 0; i < queries.size; ++i) {
    // The same three squares, perhaps added in another order: a few roundings of 2^-53.
    ASSERT_NEAR(ours.sq_dist[i], flann.sq_dist[i], 1e-15 * flann.sq_dist[i]);
  }
}

}  // namespace nearest_test
}  // namespace cmap
