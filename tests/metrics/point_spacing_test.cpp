#include "cmap/metrics/point_spacing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cmap/core/execution.hpp"
#include "metrics/map_pairs.hpp"

namespace cmap {
namespace point_spacing_test {

PointSpacing spacing_of(const PointCloud& cloud) { return point_spacing(Bvh(sort_points(cloud))); }

TEST(PointSpacing, ByHand) {
  // Nearest other points: 1, 1, 2, 5 m away.
  const PointSpacing found = spacing_of(test::cloud_of({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {3, 5, 0}}));
  EXPECT_EQ(found.n, 4u);
  EXPECT_EQ(found.n_copies, 0u);
  EXPECT_DOUBLE_EQ(found.median_m, 1.5);
  EXPECT_DOUBLE_EQ(found.mean_m, 2.25);
}

TEST(PointSpacing, OfAGridIsItsStep) {
  const PointSpacing found = spacing_of(test::grid_cloud(20));
  EXPECT_EQ(found.n, 1200u);
  EXPECT_EQ(found.median_m, 1.0);
  EXPECT_EQ(found.mean_m, 1.0);
}

TEST(PointSpacing, CopiesMakeAMapNoDenser) {
  const PointCloud once = test::sheet_cloud(3000, 1);
  const PointSpacing expected = spacing_of(once);
  for (int times : {2, 3, 100}) {
    const PointSpacing found = spacing_of(test::repeated(once, times));
    EXPECT_EQ(found.n, expected.n);
    EXPECT_EQ(found.n_copies, once.size() * static_cast<std::size_t>(times - 1));
    EXPECT_EQ(found.median_m, expected.median_m);
    EXPECT_NEAR(found.mean_m, expected.mean_m, 1e-12 * expected.mean_m);
  }
}

TEST(PointSpacing, OnePlaceHasNoSpacing) {
  for (int times : {1, 2, 200'000}) {
    const PointSpacing found = spacing_of(test::repeated(test::cloud_of({{1, 2, 3}}), times));
    EXPECT_EQ(found.n, 1u);
    EXPECT_EQ(found.n_copies, static_cast<std::uint64_t>(times - 1));
    EXPECT_TRUE(std::isnan(found.median_m));
    EXPECT_TRUE(std::isnan(found.mean_m));
  }
}

/// By the definition, over all pairs.
PointSpacing by_brute_force(const PointCloud& cloud) {
  std::vector<Eigen::Vector3d> places;
  for (const Eigen::Vector3f& p : cloud.positions) {
    if (std::ranges::count(places, p.cast<double>()) == 0) places.push_back(p.cast<double>());
  }
  std::vector<double> distances_m;
  for (const Eigen::Vector3d& a : places) {
    double nearest = INFINITY;
    for (const Eigen::Vector3d& b : places) {
      if (a != b) nearest = std::min(nearest, (a - b).norm());
    }
    distances_m.push_back(nearest);
  }
  std::ranges::sort(distances_m);
  const std::size_t n = distances_m.size();
  return {0.5 * (distances_m[(n - 1) / 2] + distances_m[n / 2]),
          std::accumulate(distances_m.begin(), distances_m.end(), 0.0) / static_cast<double>(n), n, cloud.size() - n};
}

TEST(PointSpacing, EqualsTheDefinition) {
  PointCloud mixed = test::sheet_cloud(901, 3);  // some points once, some up to four times
  for (std::size_t i = 0; i < 200; ++i) mixed.positions.push_back(mixed.positions[i * i % 300]);
  for (const PointCloud& cloud : {test::uniform_cloud(1000, 2), test::sheet_cloud(701, 1), mixed}) {
    const PointSpacing found = spacing_of(cloud), expected = by_brute_force(cloud);
    EXPECT_EQ(found.n, expected.n);
    EXPECT_EQ(found.n_copies, expected.n_copies);
    EXPECT_NEAR(found.median_m, expected.median_m, 1e-12);
    EXPECT_NEAR(found.mean_m, expected.mean_m, 1e-12);
  }
}

TEST(PointSpacing, TheSameForAnyNumberOfThreads) {
  const Bvh map(sort_points(test::sheet_cloud(200'000, 4)));
  const PointSpacing all = point_spacing(map);
  const ExecutionScope limit({.threads = 1});
  const PointSpacing one = point_spacing(map);
  EXPECT_EQ(one.mean_m, all.mean_m);
  EXPECT_EQ(one.median_m, all.median_m);
}

}  // namespace point_spacing_test
}  // namespace cmap
