#include "odometry/scan_points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace cmap {
namespace scan_points_test {

using Eigen::Vector3f;
using ::testing::ElementsAre;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

LidarScan scan_of(const std::vector<Vector3f>& positions, const std::vector<float>& times) {
  LidarScan scan;
  scan.timestamp_s = 100.0;
  for (const Vector3f& p : positions) scan.positions.push_back(p);
  for (const float t : times) scan.time_s.push_back(t);
  return scan;
}

OdometryOptions within(double min_m, double max_m) {
  OdometryOptions options;
  options.min_range_m = min_m;
  options.max_range_m = max_m;
  return options;
}

TEST(ScanPoints, AreThoseWithinRange) {
  const auto found = scan_points(
      scan_of({{0.5F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, -3.0F, 4.0F}, {0.0F, 10.0F, 0.0F}, {0.0F, 0.0F, 10.5F}},
              {}),
      within(1.0, 10.0));
  ASSERT_EQ(found.positions.size(), 3U);
  EXPECT_EQ(found.positions[0], Vector3f(1.0F, 0.0F, 0.0F)) << "the bounds are within";
  EXPECT_EQ(found.positions[1], Vector3f(0.0F, -3.0F, 4.0F));
  EXPECT_EQ(found.positions[2], Vector3f(0.0F, 10.0F, 0.0F));
  EXPECT_EQ(found.n_measured, 5U);
}

TEST(ScanPoints, WithoutTimesAreOfOneInstant) {
  const auto found = scan_points(scan_of({{2, 0, 0}, {3, 0, 0}}, {}), {});
  EXPECT_EQ(found.begin_s, 100.0);
  EXPECT_EQ(found.end_s, 100.0);
  EXPECT_THAT(found.before_end_s, ElementsAre(0.0F, 0.0F));
}

TEST(ScanPoints, HaveTheTimesThatTheSensorGives) {
  // In no order, before and after the stamp, not stretched to a turn.
  const auto found = scan_points(scan_of({{2, 0, 0}, {3, 0, 0}, {4, 0, 0}}, {-0.0625F, 0.0078125F, -0.03125F}), {});
  EXPECT_EQ(found.begin_s, 100.0 - 0.0625);
  EXPECT_EQ(found.end_s, 100.0 + 0.0078125);
  EXPECT_THAT(found.before_end_s, ElementsAre(0.0703125F, 0.0F, 0.0390625F));
}

TEST(ScanPoints, WithEqualTimesAreOfThatInstant) {
  const auto found = scan_points(scan_of({{2, 0, 0}, {3, 0, 0}}, {0.25F, 0.25F}), {});
  EXPECT_EQ(found.begin_s, 100.25);
  EXPECT_EQ(found.end_s, 100.25);
  EXPECT_THAT(found.before_end_s, ElementsAre(0.0F, 0.0F));
}

TEST(ScanPoints, PointsThatAreNoneGiveNothingButTheirTimes) {
  const auto found = scan_points(
      scan_of({{kNan, 0, 0}, {2, 0, 0}, {0, kInfinity, 0}, {3, kNan, 0}}, {0.0F, 0.03125F, 0.0625F, 0.125F}), {});
  ASSERT_EQ(found.positions.size(), 1U);
  EXPECT_EQ(found.begin_s, 100.0) << "so that begin and end do not wander with what returned";
  EXPECT_EQ(found.end_s, 100.125);
  EXPECT_THAT(found.before_end_s, ElementsAre(0.09375F));
}

TEST(ScanPoints, OfAnEmptyScanAreNone) {
  const auto found = scan_points(scan_of({}, {}), {});
  EXPECT_TRUE(found.positions.empty());
  EXPECT_EQ(found.n_measured, 0U);
  EXPECT_EQ(found.begin_s, 100.0);
  EXPECT_EQ(found.end_s, 100.0);
}

TEST(ScanPoints, AllWithinTheBlindRangeAreNone) {
  const auto found = scan_points(scan_of({{0.1F, 0, 0}, {0, 0.2F, 0}}, {0.0F, 0.0625F}), within(0.5, 10.0));
  EXPECT_TRUE(found.positions.empty());
  EXPECT_EQ(found.n_measured, 2U);
  EXPECT_EQ(found.end_s, 100.0625);
}

TEST(Thinned, KeepsTheFirstOfEachVoxel) {
  const std::vector<Vector3f> points{{0.1F, 0.1F, 0.1F},  {0.9F, 0.9F, 0.9F},  {1.0F, 0.1F, 0.1F},
                                     {-0.1F, 0.1F, 0.1F}, {0.1F, -1.0F, 0.1F}, {0.1F, -0.001F, 0.1F},
                                     {-0.9F, 0.2F, 0.2F}};
  EXPECT_THAT(thinned(points, 1.0, 100), ElementsAre(0U, 2U, 3U, 4U)) << "cells begin at whole multiples, below 0 too";
}

TEST(Thinned, TakesSomeEvenly) {
  std::vector<Vector3f> points;
  for (int i = 0; i < 10; ++i) points.emplace_back(static_cast<float>(i) + 0.5F, 0.5F, 0.5F);
  EXPECT_THAT(thinned(points, 1.0, 5), ElementsAre(0U, 2U, 4U, 6U, 8U));
  EXPECT_EQ(thinned(points, 1.0, 10).size(), 10U);
  EXPECT_THAT(thinned(points, 2.0, 10), ElementsAre(0U, 2U, 4U, 6U, 8U));
  EXPECT_TRUE(thinned({}, 1.0, 10).empty());
}

}  // namespace scan_points_test
}  // namespace cmap
