#include "cmap/geometry/point_cloud.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <stdexcept>

namespace cmap {
namespace point_cloud_test {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector3f;

const Vector3d kUtm(5e5, 4e6, 100.0);

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

Vector3d uniform_vector(std::mt19937_64& random, double low, double high) {
  const double x = uniform(random, low, high), y = uniform(random, low, high), z = uniform(random, low, high);
  return {x, y, z};
}

PointCloud random_cloud(std::size_t n, const Vector3d& origin, double side, unsigned seed) {
  std::mt19937_64 random(seed);
  PointCloud cloud;
  cloud.origin = origin;
  for (std::size_t i = 0; i < n; ++i) cloud.positions.push_back(uniform_vector(random, 0.0, side).cast<float>());
  return cloud;
}

/// Four points on a line with the given colors.
PointCloud four_points(const Colors& colors = {}) {
  PointCloud cloud;
  cloud.origin = kUtm;
  cloud.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  cloud.colors = colors;
  return cloud;
}

struct ColorsOfFour {
  Colors four;
  Colors first_and_last;
};

/// One case for each way to store colors.
std::vector<ColorsOfFour> every_color_type() {
  return {
      {Colors{}, Colors{}},
      {Array<Rgb8>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 255}}, Array<Rgb8>{{1, 2, 3}, {10, 11, 255}}},
      {Array<Rgb16>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 65535}}, Array<Rgb16>{{1, 2, 3}, {10, 11, 65535}}},
      {Array<RgbF>{{0.1f, 0, 0}, {0.2f, 0, 0}, {0.3f, 0, 0}, {0, 0.4f, 1}}, Array<RgbF>{{0.1f, 0, 0}, {0, 0.4f, 1}}}};
}

Matrix4d similarity(double scale, const Eigen::AngleAxisd& rotation, const Vector3d& translation) {
  Matrix4d T = Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = scale * rotation.toRotationMatrix();
  T.topRightCorner<3, 1>() = translation;
  return T;
}

/// Largest distance of the moved cloud's points from those moved one by one in double precision.
double transform_error(const PointCloud& cloud, const Matrix4d& T) {
  const PointCloud moved = transformed(cloud, T);
  EXPECT_EQ(moved.size(), cloud.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d expected = (T * cloud.world(i).homogeneous()).head<3>();
    const double error = (moved.world(i) - expected).norm();
    if (!(error <= largest)) largest = error;  // keeps NaN
  }
  return largest;
}

TEST(Colors, TypeNames) {
  EXPECT_EQ(color_type_name(Colors{}), "none");
  EXPECT_EQ(color_type_name(Array<Rgb8>{}), "u8");
  EXPECT_EQ(color_type_name(Array<Rgb16>{}), "u16");
  EXPECT_EQ(color_type_name(Array<RgbF>{}), "f32");
}

TEST(PointCloud, HasColorWhereThereIsAColorArray) {
  EXPECT_FALSE(four_points().has_color());
  EXPECT_TRUE(four_points(every_color_type()[1].four).has_color());
}

TEST(Bounds, AreTheExtremesOfEachAxisInTheWorldFrame) {
  PointCloud cloud;
  cloud.origin = {5e5, 4e6, -100.0};
  cloud.positions = {{-1, 5, 0.5f}, {2, -3, 0.25f}, {0, 0, 4}};
  const Box3d box = bounds(cloud);
  EXPECT_EQ(box.min, Vector3d(499999.0, 3999997.0, -99.75));
  EXPECT_EQ(box.max, Vector3d(500002.0, 4000005.0, -96.0));
}

TEST(Bounds, OfOnePointAreThePoint) {
  PointCloud cloud;
  cloud.positions = {{-1, -2, -3}};
  EXPECT_EQ(bounds(cloud).min, Vector3d(-1, -2, -3));
  EXPECT_EQ(bounds(cloud).max, Vector3d(-1, -2, -3));
}

TEST(Bounds, OfNothingAreRefused) { EXPECT_THROW(bounds(PointCloud{}), std::invalid_argument); }

TEST(ChooseOrigin, IsZeroForBoxesThatContainZero) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    const double size = std::pow(10.0, uniform(random, -6.0, 9.0));
    const Box3d box{uniform_vector(random, -size, 0.0), uniform_vector(random, 0.0, size)};
    ASSERT_EQ(choose_origin(box), Vector3d::Zero()) << box.min.transpose() << " to " << box.max.transpose();
  }
  EXPECT_EQ(choose_origin({Vector3d::Zero(), Vector3d::Zero()}), Vector3d::Zero());
}

TEST(ChooseOrigin, TakesEachAxisByItself) {
  // The extents 10, 600 and 1 have units of 100, 1000 and 100.
  EXPECT_EQ(choose_origin({{500120, 4000200, 0}, {500130, 4000800, 1}}), Vector3d(500100, 4001000, 0));
  EXPECT_EQ(choose_origin({{-7.2, 25, 1234}, {-7.1, 55, 1235}}), Vector3d(0, 0, 1200));
  EXPECT_EQ(choose_origin({{-77.2, 61, -1235}, {-77.1, 61, -1234}}), Vector3d(-100, 100, -1200));
}

TEST(ChooseOrigin, KeepsOffsetsSmallAgainstTheExtent) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 1000; ++i) {
    const double extent = std::pow(10.0, uniform(random, -3.0, 4.0));
    const Vector3d min = uniform_vector(random, -5e6, 5e6);
    const Box3d box{min, min + uniform_vector(random, 0.5 * extent, extent)};
    const Vector3d center = 0.5 * (box.min + box.max);
    const Vector3d origin = choose_origin(box);
    for (int axis = 0; axis < 3; ++axis) {
      // The unit is 100 or less than 10 extents (the next smaller power of ten was too small); half of it at most.
      const double limit = std::max(50.0, 5.0 * (box.max[axis] - box.min[axis]));
      ASSERT_LE(std::abs(center[axis] - origin[axis]), limit);
    }
  }
}

/// The origin of the shifted box less the shift: equal for all shifts of round numbers.
Vector3d origin_after_shift(const Box3d& box, const Vector3d& shift) {
  return choose_origin({box.min + shift, box.max + shift}) - shift;
}

TEST(ChooseOrigin, FollowsAShiftOfRoundNumbers) {
  // In steps of 1/1024 m, so that the shifted bounds are exact; up to 50 m, so that 100 is a multiple of every unit.
  std::mt19937_64 random(3);
  const auto grid = [](const Vector3d& v) { return Vector3d((v * 1024.0).array().round() / 1024.0); };
  for (int i = 0; i < 1000; ++i) {
    const double extent = std::pow(10.0, uniform(random, -2.0, 1.69));
    const Vector3d min = grid(uniform_vector(random, -200.0, 200.0));
    const Box3d box{min, min + grid(uniform_vector(random, 0.5 * extent, extent))};
    ASSERT_EQ(origin_after_shift(box, kUtm), choose_origin(box))
        << box.min.transpose() << " to " << box.max.transpose();
    ASSERT_EQ(origin_after_shift(box, -kUtm), choose_origin(box))
        << box.min.transpose() << " to " << box.max.transpose();
  }
}

TEST(ChooseOrigin, FollowsAShiftWhereTheCenterIsHalfwayBetweenUnits) {
  // Extent 20 m, unit 100 m, center -50 m.
  const Box3d box{Vector3d::Constant(-60.0), Vector3d::Constant(-40.0)};
  EXPECT_EQ(origin_after_shift(box, kUtm), choose_origin(box));
  EXPECT_EQ(origin_after_shift(box, Vector3d::Constant(100.0)), choose_origin(box));
}

TEST(Select, KeepsTheMarkedPointsInOrderWithEveryColorType) {
  for (const ColorsOfFour& colors : every_color_type()) {
    const PointCloud kept = select(four_points(colors.four), {1, 0, 0, 255});
    EXPECT_EQ(kept.origin, kUtm);
    EXPECT_EQ(kept.positions, (Array<Vector3f>{{0, 0, 0}, {3, 0, 0}}));
    EXPECT_EQ(kept.colors, colors.first_and_last) << color_type_name(colors.four);
  }
}

TEST(Select, OfNoneIsEmptyButStillColored) {
  const PointCloud kept = select(four_points(every_color_type()[2].four), {0, 0, 0, 0});
  EXPECT_EQ(kept.size(), 0u);
  EXPECT_EQ(kept.colors, Colors(Array<Rgb16>{}));
  EXPECT_EQ(select(PointCloud{}, {}).size(), 0u);
}

TEST(Select, NeedsOneFlagPerPoint) {
  EXPECT_THROW(select(four_points(), {1, 1, 1}), std::invalid_argument);
  EXPECT_THROW(select(four_points(), {1, 1, 1, 1, 1}), std::invalid_argument);
}

TEST(Crop, IncludesTheBoundsOnEveryAxis) {
  PointCloud cloud;
  for (int axis = 0; axis < 3; ++axis) {
    for (float x : {-1.0f, std::nextafter(-1.0f, -2.0f), 2.0f, std::nextafter(2.0f, 3.0f)}) {
      cloud.positions.push_back(Vector3f::Unit(axis) * x);
    }
  }
  const PointCloud inside = crop(cloud, {Vector3d::Constant(-1.0), Vector3d::Constant(2.0)});
  EXPECT_EQ(inside.positions, (Array<Vector3f>{{-1, 0, 0}, {2, 0, 0}, {0, -1, 0}, {0, 2, 0}, {0, 0, -1}, {0, 0, 2}}));
}

TEST(Crop, DecidesInTheWorldFrame) {
  PointCloud cloud;
  cloud.origin = kUtm;
  // A float at 4e6 m has steps of 0.25 m; these points are a millimeter on either side of the border.
  cloud.positions = {{0, 0.999f, 0}, {0, 1.001f, 0}, {0, 2.999f, 0}, {0, 3.001f, 0}};
  cloud.colors = every_color_type()[1].four;
  const PointCloud inside = crop(cloud, {kUtm + Vector3d(-1, 1, -1), kUtm + Vector3d(1, 3, 1)});
  EXPECT_EQ(inside.origin, kUtm);
  EXPECT_EQ(inside.positions, (Array<Vector3f>{{0, 1.001f, 0}, {0, 2.999f, 0}}));
  EXPECT_EQ(inside.colors, Colors(Array<Rgb8>{{4, 5, 6}, {7, 8, 9}}));
}

TEST(Crop, OfEverythingOrNothing) {
  const PointCloud cloud = four_points();
  EXPECT_EQ(crop(cloud, bounds(cloud)).positions, cloud.positions);
  EXPECT_EQ(crop(cloud, {Vector3d::Zero(), Vector3d::Ones()}).size(), 0u);
  EXPECT_EQ(crop(PointCloud{}, {Vector3d::Zero(), Vector3d::Ones()}).size(), 0u);
}

// Half a step of a float below 128 m, along three axes: sqrt 3 * 3.82e-6 m; doubles at 4e6 m add 1e-9 m.
constexpr double kFloatRounding_m = 6.62e-6;
const Eigen::AngleAxisd kRotation(0.8, Vector3d(1, -2, 3).normalized());

TEST(Transformed, EqualsEachPointMovedInDouble) {
  const Matrix4d T = similarity(2.5, kRotation, {10, -20, 30});
  EXPECT_LE(transform_error(random_cloud(1000, Vector3d::Zero(), 10.0, 4), T), kFloatRounding_m);
  EXPECT_LE(transform_error(random_cloud(1000, {7, -8, 9}, 10.0, 5), T), kFloatRounding_m);
}

TEST(Transformed, KeepsPrecisionAtUtmCoordinates) {
  const Matrix4d to_utm = similarity(1.0, kRotation, {512345.678, 4123456.789, 123.4});
  // 10 m across, so that offsets stay below 128 m.
  const PointCloud local = random_cloud(1000, Vector3d::Zero(), 10.0, 6);
  EXPECT_LE(transform_error(local, to_utm), kFloatRounding_m);
  const PointCloud utm = random_cloud(1000, {512345.0, 4123456.0, 123.0}, 10.0, 7);
  EXPECT_LE(transform_error(utm, similarity(1.0, kRotation, Vector3d::Zero())), kFloatRounding_m);
  EXPECT_LE(transform_error(utm, to_utm.inverse()), kFloatRounding_m);
}

TEST(Transformed, ThereAndBackReturnsEveryPoint) {
  const Matrix4d T = similarity(0.4, kRotation, kUtm);
  const PointCloud cloud = random_cloud(1000, Vector3d::Zero(), 10.0, 8);
  const PointCloud back = transformed(transformed(cloud, T), T.inverse());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_LE((back.world(i) - cloud.world(i)).norm(), kFloatRounding_m * (1.0 + 1.0 / 0.4));
  }
}

TEST(Transformed, IdentityKeepsTheFloatsOfACloudAroundZero) {
  PointCloud cloud = random_cloud(100, Vector3d::Zero(), 10.0, 9);
  cloud.positions.push_back(Vector3f::Zero());
  const PointCloud same = transformed(cloud, Matrix4d::Identity());
  EXPECT_EQ(same.origin, Vector3d::Zero());
  EXPECT_EQ(same.positions, cloud.positions);
}

TEST(Transformed, KeepsEveryColorType) {
  const Matrix4d T = similarity(1.0, kRotation, {1, 2, 3});
  for (const ColorsOfFour& colors : every_color_type()) {
    EXPECT_EQ(transformed(four_points(colors.four), T).colors, colors.four) << color_type_name(colors.four);
  }
}

TEST(Transformed, AStrayDoesNotTakeTheDigitsOfTheOthers) {
  PointCloud cloud = random_cloud(50, Vector3d::Zero(), 10.0, 4);
  cloud.positions.push_back({1e8f, 0, 0});
  const PointCloud moved = transformed(cloud, similarity(1.0, Eigen::AngleAxisd::Identity(), kUtm));
  EXPECT_EQ(moved.origin, kUtm);
  for (std::size_t i = 0; i < 50; ++i) ASSERT_LT((moved.world(i) - kUtm - cloud.world(i)).norm(), 1e-9);
}

TEST(FileStep, GoesWithTheCloud) {
  PointCloud cloud = four_points();
  cloud.file_step_m = 0.01;
  EXPECT_EQ(select(cloud, {1, 1, 0, 0}).file_step_m, 0.01);
  EXPECT_EQ(crop(cloud, bounds(cloud)).file_step_m, 0.01);
  const Eigen::AngleAxisd turn(0.3, Vector3d::UnitX());
  EXPECT_NEAR(transformed(cloud, similarity(2.0, turn, kUtm)).file_step_m, 0.02, 1e-15);
}

TEST(Transformed, OfNothingIsEmptyButStillColored) {
  PointCloud empty;
  empty.colors.emplace<Array<RgbF>>();
  const PointCloud moved = transformed(empty, similarity(2.0, kRotation, kUtm));
  EXPECT_EQ(moved.size(), 0u);
  EXPECT_EQ(color_type_name(moved.colors), "f32");
}

}  // namespace point_cloud_test
}  // namespace cmap
