#include "odometry/degeneracy.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace cmap {
namespace degeneracy_test {

using Eigen::Vector3d;

constexpr double kLeast = 10.0;
constexpr double kTilt_rad = 0.009;  // half a degree

/// Surfaces about a sensor at the origin, seen at random places, normals off by half a degree.
class Surroundings {
 public:
  /// `n` points where a plane of that normal, `distance_m` away, is within 20 m across and as far along.
  void add(const Vector3d& normal, double distance_m, int n) {
    const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
    std::uniform_real_distribution<double> place(-20.0, 20.0);
    std::normal_distribution<double> noise(0.0, kTilt_rad);
    for (int i = 0; i < n; ++i) {
      const Vector3d point = distance_m * normal + place(random_) * u + place(random_) * v;
      const Vector3d seen = (normal + noise(random_) * u + noise(random_) * v).normalized();
      const PoseVector jacobian = plane_jacobian(Eigen::Matrix3d::Identity(), seen, point, 1.0);
      directions.add(seen.cast<float>(), jacobian, static_cast<float>(kTilt_rad * kTilt_rad));
      system.add({0.01, 1e-3, jacobian}, 1.0);
    }
  }
  OpenDirections open() const { return open_directions(directions, kLeast); }

  PlaneDirections directions;
  PlaneSystem system;

 private:
  std::mt19937 random_{3};
};

/// Within two degrees, either way.
void expect_along(const Vector3d& found, const Vector3d& expected) {
  EXPECT_NEAR(found.norm(), 1.0, 1e-9);
  EXPECT_GT(std::abs(found.dot(expected)), 0.9994) << found.transpose();
}

TEST(OpenDirections, ARoomHasNone) {
  Surroundings room;
  for (int axis = 0; axis < 3; ++axis) {
    room.add(Vector3d::Unit(axis), 4.0, 300);
    room.add(-Vector3d::Unit(axis), 5.0, 300);
  }
  EXPECT_FALSE(room.open().any());
}

TEST(OpenDirections, ACorridorIsOpenAlong) {
  Surroundings corridor;
  const Vector3d along = Vector3d(1.0, 0.4, 0.0).normalized(), across(-along.y(), along.x(), 0.0);
  corridor.add(across, 1.0, 800);
  corridor.add(-across, 1.0, 800);
  corridor.add(-Vector3d::UnitZ(), 1.5, 800);
  corridor.add(Vector3d::UnitZ(), 1.2, 800);
  const OpenDirections open = corridor.open();
  ASSERT_EQ(open.shifts.size(), 1U);
  expect_along(open.shifts[0], along);
  EXPECT_TRUE(open.turns.empty());
}

TEST(OpenDirections, ACorridorsEndCloses) {
  Surroundings corridor;
  corridor.add(Vector3d::UnitY(), 1.0, 800);
  corridor.add(-Vector3d::UnitZ(), 1.5, 800);
  corridor.add(Vector3d::UnitX(), 15.0, 8);
  EXPECT_EQ(corridor.open().shifts.size(), 1U) << "eight points of it";
  corridor.add(Vector3d::UnitX(), 15.0, 4);
  EXPECT_TRUE(corridor.open().shifts.empty()) << "twelve";
}

TEST(OpenDirections, FlatGroundIsOpenInTwoShiftsAndATurn) {
  Surroundings ground;
  ground.add(-Vector3d::UnitZ(), 2.0, 2000);
  const OpenDirections open = ground.open();
  ASSERT_EQ(open.shifts.size(), 2U);
  EXPECT_LT(std::abs(open.shifts[0].z()), 0.02);
  EXPECT_LT(std::abs(open.shifts[1].z()), 0.02);
  ASSERT_EQ(open.turns.size(), 1U);
  expect_along(open.turns[0], Vector3d::UnitZ());
}

TEST(OpenDirections, OneWallToo) {
  Surroundings wall;
  wall.add(Vector3d(0.6, 0.8, 0.0), 6.0, 2000);
  const OpenDirections open = wall.open();
  ASSERT_EQ(open.shifts.size(), 2U);
  for (const Vector3d& shift : open.shifts) EXPECT_LT(std::abs(shift.dot(Vector3d(0.6, 0.8, 0.0))), 0.02);
  ASSERT_EQ(open.turns.size(), 1U);
  expect_along(open.turns[0], {0.6, 0.8, 0.0});
}

TEST(OpenDirections, OfNothingAreAll) {
  const OpenDirections open = open_directions({}, kLeast);
  EXPECT_EQ(open.shifts.size(), 3U);
  EXPECT_EQ(open.turns.size(), 3U);
}

TEST(RemoveOpen, LeavesNothingOfTheOpenAndAllOfTheRest) {
  Surroundings ground;
  ground.add(-Vector3d::UnitZ(), 2.0, 500);
  PlaneSystem system = ground.system;
  const OpenDirections open = ground.open();
  remove_open(system, open);
  for (const Vector3d& shift : open.shifts) {
    PoseVector direction = PoseVector::Zero();
    direction.tail<3>() = shift;
    EXPECT_LT((system.information * direction).norm(), 1e-9 * ground.system.information.norm());
    EXPECT_LT(std::abs(system.gradient.dot(direction)), 1e-9 * ground.system.gradient.norm());
  }
  PoseVector up = PoseVector::Zero();
  up.tail<3>() = open.shifts[0].cross(open.shifts[1]);
  EXPECT_NEAR(up.dot(system.information * up), up.dot(ground.system.information * up),
              1e-9 * ground.system.information.norm());
  EXPECT_EQ(system.n, ground.system.n);
}

TEST(RemoveOpen, OfNoneChangesNothing) {
  Surroundings ground;
  ground.add(-Vector3d::UnitZ(), 2.0, 50);
  PlaneSystem system = ground.system;
  remove_open(system, {});
  EXPECT_EQ(system.information, ground.system.information);
  EXPECT_EQ(system.gradient, ground.system.gradient);
}

}  // namespace degeneracy_test
}  // namespace cmap
