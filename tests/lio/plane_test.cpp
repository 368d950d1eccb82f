#include "map/plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace cmap {
namespace plane_test {

using Eigen::Vector3d;

constexpr double kCell_m = 1.0;
const PlaneRule kRule;

/// The corners of a box with those half edges about a middle: their variances are the squares of a, b, c.
PointSums corners(double a, double b, double c, const Vector3d& middle, double variance_m2 = 1e-6) {
  PointSums sums;
  for (int i = 0; i < 8; ++i) {
    const Vector3d corner((i & 1) != 0 ? a : -a, (i & 2) != 0 ? b : -b, (i & 4) != 0 ? c : -c);
    sums.add(middle + corner, variance_m2);
  }
  return sums;
}

TEST(Plane, OfABoxsCornersByHand) {
  const Vector3d origin(4.5e5, 5.4e6, -3.0), middle(0.5, 0.4, 0.3);
  const auto plane = fit_plane(corners(0.4, 0.2, 0.01, middle), origin, kCell_m, kRule);
  ASSERT_TRUE(plane);
  EXPECT_LT((plane->center - origin - middle).norm(), 2e-9) << "doubles at 5.4e6";
  EXPECT_NEAR(std::abs(plane->normal.z()), 1.0, 1e-6);
  EXPECT_NEAR(std::abs(plane->long_axis.x()), 1.0, 1e-6);
  EXPECT_NEAR(std::abs(plane->short_axis.y()), 1.0, 1e-6);
  EXPECT_NEAR(plane->long_variance, 0.16, 1e-6);
  EXPECT_NEAR(plane->short_variance, 0.04, 1e-6);
  // 1e-4 across, of eight points of which five say so: 1.6e-4.
  EXPECT_NEAR(plane->offset_variance, 1.6e-4 / 8.0, 1e-10);
  EXPECT_NEAR(plane->long_slope_variance, 1.6e-4 / (8.0 * 0.16), 1e-9);
  EXPECT_NEAR(plane->short_slope_variance, 1.6e-4 / (8.0 * 0.04), 1e-9);
}

TEST(Plane, MeasurementsOfAThinOneSayHowUncertainItIs) {
  const auto plane = fit_plane(corners(0.4, 0.2, 0.0, {0.5, 0.5, 0.5}, 4e-4), Vector3d::Zero(), kCell_m, kRule);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->offset_variance, 4e-4 / 8.0, 1e-10);
  // Beside the center slopes count by the square of the distance.
  const double at_edge = 4e-4 / 8.0 + 0.3 * 0.3 * 4e-4 / (8.0 * 0.16) + 0.1 * 0.1 * 4e-4 / (8.0 * 0.04);
  EXPECT_NEAR(plane->variance_at({0.3F, 0.1F, 0.0F}), at_edge, 1e-9);
}

TEST(Plane, DistanceIsAlongTheNormal) {
  const auto plane = fit_plane(corners(0.4, 0.2, 0.0, {0.5, 0.5, 0.5}), Vector3d::Zero(), kCell_m, kRule);
  ASSERT_TRUE(plane);
  const double up = plane->normal.z() > 0.0F ? 1.0 : -1.0;
  EXPECT_NEAR(plane->distance_m({7.0, -3.0, 0.75}), 0.25 * up, 1e-6);
}

TEST(Plane, OfTooFewPointsIsNone) {
  PointSums sums;
  for (int i = 0; i < 5; ++i) sums.add({0.2 * i, 0.1 * i * i, 0.0}, 1e-6);
  EXPECT_FALSE(fit_plane(sums, Vector3d::Zero(), kCell_m, kRule));
  sums.add({0.0, 0.9, 0.0}, 1e-6);
  EXPECT_TRUE(fit_plane(sums, Vector3d::Zero(), kCell_m, kRule)) << "six are enough";
  EXPECT_FALSE(fit_plane(PointSums{}, Vector3d::Zero(), kCell_m, kRule));
}

TEST(Plane, OfALineOrAPointIsNone) {
  EXPECT_FALSE(fit_plane(corners(0.4, 0.0, 0.0, {0.5, 0.5, 0.5}), Vector3d::Zero(), kCell_m, kRule));
  EXPECT_FALSE(fit_plane(corners(0.0, 0.0, 0.0, {0.5, 0.5, 0.5}), Vector3d::Zero(), kCell_m, kRule));
  EXPECT_FALSE(fit_plane(corners(0.4, 0.02, 0.01, {0.5, 0.5, 0.5}), Vector3d::Zero(), kCell_m, kRule))
      << "half as thick as wide";
}

TEST(Plane, OfAThickOneIsNone) {
  EXPECT_TRUE(fit_plane(corners(0.4, 0.3, 0.049, {0.5, 0.5, 0.5}), Vector3d::Zero(), kCell_m, kRule));
  EXPECT_FALSE(fit_plane(corners(0.4, 0.3, 0.051, {0.5, 0.5, 0.5}), Vector3d::Zero(), kCell_m, kRule));
  EXPECT_FALSE(fit_plane(corners(0.1, 0.1, 0.026, {0.1, 0.1, 0.1}), Vector3d::Zero(), 0.25, kRule))
      << "a tenth of a small cell";
}

TEST(Plane, IsAsUncertainAsManyFitsOfItAre) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  const int n_fits = 4000;
  double sq_offset = 0.0, sq_slope = 0.0, offset = 0.0, slope = 0.0;
  for (int fit = 0; fit < n_fits; ++fit) {
    PointSums sums;
    for (int i = 0; i < 40; ++i) sums.add({place(random), 0.5 * place(random), 0.3 + noise(random)}, 4e-4);
    const auto plane = fit_plane(sums, Vector3d::Zero(), kCell_m, kRule);
    ASSERT_TRUE(plane);
    const Vector3d normal = plane->normal.cast<double>() * (plane->normal.z() > 0.0F ? 1.0 : -1.0);
    sq_offset += std::pow(normal.dot(Vector3d(0.0, 0.0, 0.3) - Vector3d(0.0, 0.0, plane->center.z())), 2);
    sq_slope += std::pow(normal.dot(plane->long_axis.cast<double>()) - plane->long_axis.z(), 2);
    offset += static_cast<double>(plane->offset_variance);
    slope += static_cast<double>(plane->long_slope_variance);
  }
  // 4000 draws know a variance to 2.2 %; five of these. Where thickness counts instead of noise, the larger of both is
  // taken: a little too much, 10 % with 40 points.
  EXPECT_NEAR(sq_offset / offset, 0.95, 0.15);
  EXPECT_NEAR(sq_slope / slope, 0.95, 0.15);
}

}  // namespace plane_test
}  // namespace cmap
