#include "cmap/spatial/visibility.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"

namespace cmap {
namespace visibility_test {

using Eigen::Vector3d;

/// Points every 10 cm on a rectangle: corner + a u + b v.
void add_rectangle(PointCloud& cloud, const Vector3d& corner, const Vector3d& u, const Vector3d& v) {
  constexpr double kStep_m = 0.1;
  const auto n_u = static_cast<int>(u.norm() / kStep_m), n_v = static_cast<int>(v.norm() / kStep_m);
  for (int i = 0; i <= n_u; ++i) {
    for (int j = 0; j <= n_v; ++j) {
      cloud.positions.push_back((corner + u * i / n_u + v * j / n_v).cast<float>());
    }
  }
}

/// Ground of 40 x 40 m and a wall of 4 m height across its middle, x = 0; coordinates are off the voxels' borders.
PointCloud street_with_wall() {
  PointCloud cloud;
  add_rectangle(cloud, {-20, -20, 0.03}, {40, 0, 0}, {0, 40, 0});
  add_rectangle(cloud, {0.03, -20, 0.03}, {0, 40, 0}, {0, 0, 4});
  return cloud;
}

bool sees(const PointCloud& cloud, const std::vector<Vector3d>& positions, const Vector3d& point,
          const VisibilityOptions& options = {}) {
  return VisibleSurfaces(Bvh(sort_points(cloud)), positions, options).contains(point);
}

TEST(Visibility, AWallHidesWhatIsBehind) {
  const PointCloud cloud = street_with_wall();
  const std::vector<Vector3d> before{{-10, 0, 2}}, behind{{10, 0, 2}}, both{{-10, 0, 2}, {10, 0, 2}};
  const Vector3d ground_before(-5, 3, 0.03), ground_behind(5, 3, 0.03), wall(0.03, 1, 2);
  EXPECT_TRUE(sees(cloud, before, ground_before));
  EXPECT_TRUE(sees(cloud, before, wall));
  EXPECT_FALSE(sees(cloud, before, ground_behind));
  EXPECT_TRUE(sees(cloud, behind, ground_behind));
  EXPECT_FALSE(sees(cloud, behind, ground_before));
  EXPECT_TRUE(sees(cloud, both, ground_before) && sees(cloud, both, ground_behind));
}

/// From 14 m up at x = -10 the wall's top (4 m) hides the ground up to x = 10 * 4 / (14 - 4) = 4 m: a hand-made shadow.
TEST(Visibility, TheShadowEndsWhereItsGeometrySays) {
  const PointCloud cloud = street_with_wall();
  const VisibleSurfaces seen(Bvh(sort_points(cloud)), std::vector<Vector3d>{{-10, 0, 14}}, {});
  for (double x = 1.0; x < 19.0; x += 0.5) {
    // Two voxels to each side of the edge are undecided: a line of sight begins 0.87 m above the ground.
    if (std::abs(x - 4.0) < 1.0) continue;
    EXPECT_EQ(seen.contains({x, 0.2, 0.03}), x > 4.0) << x;
  }
}

/// Seen at 2 degrees, every line of sight runs through the ground's own voxels for meters.
TEST(Visibility, FlatGroundDoesNotHideItself) {
  PointCloud cloud;
  add_rectangle(cloud, {0, -5, 0.03}, {60, 0, 0}, {0, 10, 0});
  const VisibleSurfaces seen(Bvh(sort_points(cloud)), std::vector<Vector3d>{{0, 0, 2}}, {});
  for (double x = 0.2; x < 59; x += 1.0) EXPECT_TRUE(seen.contains({x, 1.0, 0.03})) << x;
}

TEST(Visibility, RangeEndsIt) {
  PointCloud cloud;
  add_rectangle(cloud, {0, -5, 0.03}, {60, 0, 0}, {0, 10, 0});
  EXPECT_TRUE(sees(cloud, {{0, 0, 2}}, {29, 0, 0.03}, {0.5, 30.0}));
  EXPECT_FALSE(sees(cloud, {{0, 0, 2}}, {31, 0, 0.03}, {0.5, 30.0}));
}

/// Any wall, any sensor: what is seen over a wall by geometry is seen, what is not is not, but for the edge.
TEST(Visibility, AgreesWithGeometryForManyPositions) {
  const PointCloud cloud = street_with_wall();
  const Bvh index(sort_points(cloud));
  int n_checked = 0;
  for (double x = -18; x < -2; x += 5) {
    for (double height = 1; height < 16; height += 3) {
      const Vector3d sensor(x, 1, height);
      const VisibleSurfaces seen(index, std::vector<Vector3d>{sensor}, {});
      for (double ground = 1.2; ground < 19; ground += 1.7) {
        const double at_wall = height * ground / (ground - x);  // of the line of sight from the ground, above z = 0
        const double margin = 1.5 * 0.87 + 0.5;                 // its start above the surface, and a voxel
        if (std::abs(at_wall - 4.0) < margin) continue;
        ++n_checked;
        EXPECT_EQ(seen.contains({ground, 1, 0.03}), at_wall > 4.0) << sensor.transpose() << " to " << ground;
      }
    }
  }
  EXPECT_GT(n_checked, 100);
}

TEST(Visibility, PositionsAreThinnedAndOrderOfThreadsDoesNotMatter) {
  const PointCloud cloud = street_with_wall();
  const Bvh index(sort_points(cloud));
  std::vector<Vector3d> path;
  for (int i = 0; i < 100; ++i) path.push_back({-15 + 0.1 * i, 2, 1.5});
  const VisibleSurfaces many(index, path, {});
  EXPECT_EQ(many.n_positions(), 20u) << "10 m of path, one position for each half meter";
  const ExecutionScope one({.threads = 1});
  const VisibleSurfaces alone(index, path, {});
  for (std::size_t slot = 0; slot < index.points.size; ++slot) {
    ASSERT_EQ(many.contains(index.points.world(slot)), alone.contains(index.points.world(slot)));
  }
}

TEST(Visibility, LargeCoordinatesChangeNothing) {
  PointCloud cloud = street_with_wall();
  const Vector3d shift(500000, 4000000, 100);
  const VisibleSurfaces near(Bvh(sort_points(cloud)), std::vector<Vector3d>{{-10, 0, 9}}, {});
  cloud.origin = shift;
  const VisibleSurfaces far(Bvh(sort_points(cloud)), std::vector<Vector3d>{Vector3d(-10, 0, 9) + shift}, {});
  for (double x = -19.03; x < 19; x += 0.7) {
    EXPECT_EQ(near.contains({x, 2.2, 0.03}), far.contains(Vector3d(x, 2.2, 0.03) + shift)) << x;
  }
}

TEST(Visibility, RefusesWhatItCannotHold) {
  PointCloud cloud = street_with_wall();
  cloud.positions.push_back({9e5f, 9e5f, 9e5f});
  const Bvh index(sort_points(cloud));
  EXPECT_THROW(VisibleSurfaces(index, std::vector<Vector3d>{{0, 0, 1}}, {}), UsageError);
  EXPECT_THROW(VisibleSurfaces(index, std::vector<Vector3d>{}, {}), std::invalid_argument);
}

}  // namespace visibility_test
}  // namespace cmap
