#include "map/plane_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace cmap {
namespace plane_map_test {

using Eigen::Vector3d;

using Points = std::vector<MapPoint>;

/// Points every 10 cm over the square of a meter that begins at `corner`, in the plane z = corner.z, in its middle.
void add_floor(Points& points, const Vector3d& corner) {
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      points.push_back({corner + Vector3d(0.05 + 0.1 * i, 0.05 + 0.1 * j, 0.0), 1e-4});
    }
  }
}
/// The same in the plane x = corner.x.
void add_wall(Points& points, const Vector3d& corner) {
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      points.push_back({corner + Vector3d(0.0, 0.05 + 0.1 * i, 0.05 + 0.1 * j), 1e-4});
    }
  }
}

PlaneMap floor_map(const Vector3d& corner) {
  PlaneMap map({});
  Points points;
  add_floor(points, corner);
  map.add(points, 0.0);
  return map;
}

TEST(PlaneMap, FindsThePlaneOfTheCell) {
  const PlaneMap map = floor_map({7.0, -4.0, 2.3});
  const Plane* plane = map.find({7.5, -3.5, 2.9});
  ASSERT_NE(plane, nullptr);
  EXPECT_NEAR(std::abs(plane->normal.z()), 1.0F, 1e-6F);
  EXPECT_LT((plane->center - Vector3d(7.5, -3.5, 2.3)).norm(), 1e-9);
  EXPECT_EQ(map.find({8.5, -3.5, 2.3}), nullptr);
  EXPECT_EQ(map.find({7.5, -3.5, 3.1}), nullptr);
  EXPECT_EQ(map.n_cells(), 1U);
}

TEST(PlaneMap, CellsBeginAtWholeMultiplesOnBothSidesOfZero) {
  for (const double x : {-2.0, -1.0, 0.0, 1.0}) {
    const PlaneMap map = floor_map({x, x, x + 0.5});
    EXPECT_NE(map.find({x, x, x}), nullptr) << x;
    EXPECT_NE(map.find({x + 0.999, x + 0.999, x + 0.999}), nullptr) << x;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d inside = Vector3d::Constant(x + 0.5);
      Vector3d below = inside, above = inside;
      below[axis] = x - 1e-9;
      above[axis] = x + 1.0;
      EXPECT_EQ(map.find(below), nullptr) << x << ", axis " << axis;
      EXPECT_EQ(map.find(above), nullptr) << x << ", axis " << axis;
    }
  }
}

TEST(PlaneMap, FindsTheNearestNeighborsPlane) {
  const PlaneMap map = floor_map({-1.0, -1.0, -0.5});
  EXPECT_NE(map.find_beside({0.1, -0.5, -0.5}), nullptr) << "just above in x";
  EXPECT_NE(map.find_beside({-1.1, -0.5, -0.5}), nullptr) << "just below in x";
  EXPECT_NE(map.find_beside({-0.5, 0.2, -0.4}), nullptr);
  EXPECT_NE(map.find_beside({-0.5, -0.5, -1.3}), nullptr);
  EXPECT_EQ(map.find_beside({0.9, -0.5, -0.5}), nullptr) << "nearer to the next one";
  EXPECT_EQ(map.find_beside({0.2, 0.1, -0.5}), nullptr) << "nearer in y";
}

TEST(PlaneMap, CellsThatAreNoPlaneAreHalved) {
  PlaneMap map({});
  Points points;
  add_floor(points, {0.0, 0.0, 0.05});
  add_wall(points, {0.05, 0.0, 0.0});
  map.add(points, 0.0);
  const Plane* floor = map.find({0.8, 0.3, 0.1});
  ASSERT_NE(floor, nullptr);
  EXPECT_NEAR(std::abs(floor->normal.z()), 1.0F, 1e-6F);
  EXPECT_LT((floor->center - Vector3d(0.75, 0.25, 0.05)).norm(), 1e-9) << "of the octant alone";
  const Plane* wall = map.find({0.1, 0.3, 0.8});
  ASSERT_NE(wall, nullptr);
  EXPECT_NEAR(std::abs(wall->normal.x()), 1.0F, 1e-6F);

  PlaneMap undivided({.levels = 1, .plane = {}});
  undivided.add(points, 0.0);
  EXPECT_EQ(undivided.find({0.8, 0.3, 0.1}), nullptr);
}

TEST(PlaneMap, PlanesGrowUntilTheySettle) {
  PlaneMap map({.most_points = 200, .plane = {}});
  Points points;
  add_floor(points, {0.0, 0.0, 0.50});
  map.add(points, 0.0);
  points.clear();
  add_floor(points, {0.0, 0.0, 0.54});
  map.add(points, 0.0);
  const Vector3d inside(0.5, 0.5, 0.5);
  ASSERT_NE(map.find(inside), nullptr);
  EXPECT_NEAR(map.find(inside)->center.z(), 0.52, 1e-9) << "the mean of both";
  points.clear();
  add_floor(points, {0.0, 0.0, 0.58});
  map.add(points, 0.0);
  EXPECT_NEAR(map.find(inside)->center.z(), 0.52, 1e-9) << "settled at 200";
}

TEST(PlaneMap, ForgetsByPath) {
  PlaneMap map({.forget_after_m = 300.0, .plane = {}});
  Points here, there;
  add_floor(here, {0.0, 0.0, 0.5});
  add_floor(there, {400.0, 0.0, 0.5});
  map.add(here, 0.0);
  map.add(there, 300.0);
  const Vector3d inside(0.5, 0.5, 0.5);
  EXPECT_NE(map.find(inside), nullptr) << "not longer ago than that";
  map.add(there, 301.0);
  EXPECT_EQ(map.find(inside), nullptr);
  Points later;
  add_floor(later, {0.0, 0.0, 0.7});
  map.add(later, 302.0);
  ASSERT_NE(map.find(inside), nullptr);
  EXPECT_NEAR(map.find(inside)->center.z(), 0.7, 1e-9) << "begun anew, not the mean";
}

TEST(PlaneMap, SeeingACellKeepsIt) {
  PlaneMap map({.most_points = 50, .forget_after_m = 300.0, .plane = {}});
  Points here;
  add_floor(here, {0.0, 0.0, 0.5});
  for (const double path_m : {0.0, 200.0, 400.0}) map.add(here, path_m);
  Points there;
  add_floor(there, {400.0, 0.0, 0.5});
  map.add(there, 650.0);
  EXPECT_NE(map.find({0.5, 0.5, 0.5}), nullptr) << "last seen 250 m ago, though settled at once";
}

/// Noisy points of many slanted planes.
Points many_points() {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> place(-4.0, 4.0);
  std::normal_distribution<double> noise(0.0, 0.01);
  Points points;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d p(place(random), place(random), 0.0);
    points.push_back({{p.x(), p.y(), 0.3 * p.x() - 0.2 * p.y() + noise(random)}, 1e-4});
  }
  return points;
}

TEST(PlaneMap, IsThatOfEachCellsPointsByThemselves) {
  const Points points = many_points();
  PlaneMap map({.levels = 1, .most_points = 1e9, .plane = {}});
  map.add(points, 0.0);
  int n_planes = 0;
  for (int x = -5; x < 5; ++x) {
    for (int y = -5; y < 5; ++y) {
      for (int z = -3; z < 3; ++z) {
        const Vector3d corner(x, y, z);
        PointSums sums;
        for (const MapPoint& p : points) {
          const Vector3d from = p.position - corner;
          if (from.minCoeff() >= 0.0 && from.maxCoeff() < 1.0) sums.add(from, p.variance_m2);
        }
        const auto expected = fit_plane(sums, corner, 1.0, {});
        const Plane* found = map.find(corner + Vector3d::Constant(0.5));
        ASSERT_EQ(found != nullptr, expected.has_value()) << corner.transpose();
        if (found == nullptr) continue;
        ++n_planes;
        EXPECT_LT((found->center - expected->center).norm(), 1e-12);
        EXPECT_LT((found->normal - expected->normal).norm(), 1e-6F);
      }
    }
  }
  EXPECT_GT(n_planes, 60);
}

TEST(PlaneMap, TheOrderOfAScansPointsCountsByRoundingAlone) {
  Points points = many_points();
  PlaneMap forward({}), backward({});
  forward.add(points, 0.0);
  std::ranges::reverse(points);
  backward.add(points, 0.0);
  for (const MapPoint& p : points) {
    const Plane* a = forward.find(p.position);
    const Plane* b = backward.find(p.position);
    ASSERT_EQ(a == nullptr, b == nullptr);
    if (a == nullptr) continue;
    EXPECT_LT((a->center - b->center).norm(), 1e-12);
    EXPECT_NEAR(std::abs(a->normal.dot(b->normal)), 1.0F, 1e-5F);
  }
}

}  // namespace plane_map_test
}  // namespace cmap
