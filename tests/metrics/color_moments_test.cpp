#include "color_moments.hpp"

#include <vector>

#include "metrics/map_pairs.hpp"

namespace cmap {
namespace color_moments_test {

struct ColoredPoint {
  Eigen::Vector3f color, place;
};

ColorMoments moments_of(const std::vector<ColoredPoint>& points) {
  ColorMoments moments;
  for (const ColoredPoint& point : points) moments.add(point.color, point.place);
  return moments;
}

void expect_same_bits(const ColorMoments& found, const ColorMoments& expected) {
  EXPECT_EQ(found.n(), expected.n());
  EXPECT_EQ(found.one_place(), expected.one_place());
  EXPECT_EQ(found.covariance_trace(), expected.covariance_trace());
}

/// Float colors of no round steps.
std::vector<ColoredPoint> random_points(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<ColoredPoint> points(n);
  for (ColoredPoint& point : points) point = {test::uniform_point(random, 255.0f), test::uniform_point(random, 1.0f)};
  return points;
}

TEST(ColorMoments, HandComputed) {
  const Eigen::Vector3f here(1, 2, 3);
  EXPECT_EQ(moments_of({}).covariance_trace(), 0.0);
  EXPECT_EQ(moments_of({{{255, 7, 0}, here}}).covariance_trace(), 0.0);
  const ColorMoments two = moments_of({{{0, 255, 0}, here}, {{255, 0, 0}, here}});
  EXPECT_EQ(two.n(), 2U);
  EXPECT_TRUE(two.one_place());
  EXPECT_EQ(two.covariance_trace(), 1.0);  // 1/2 in each of two channels
}

TEST(ColorMoments, EqualTheDefinition) {
  const std::vector<ColoredPoint> points = random_points(1000, 1);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const ColoredPoint& point : points) mean += point.color.cast<double>() / 1000.0;
  double trace = 0.0;
  for (const ColoredPoint& point : points) trace += (point.color.cast<double>() - mean).squaredNorm() / 999.0;
  // Channels below 1/2, a few of these, are rounded by up to 2^-25: of a trace of 16,000 less than 1e-11.
  EXPECT_NEAR_RELATIVE(moments_of(points).covariance_trace(), trace / (255.0 * 255.0), 1e-11);
}

TEST(ColorMoments, NeitherOrderNorPartsChangeABit) {
  std::vector<ColoredPoint> points = random_points(30'000, 2);
  const ColorMoments whole = moments_of(points);
  std::mt19937_64 random(3);
  for (const std::size_t n_parts : {1u, 8u, 1000u}) {
    std::ranges::shuffle(points, random);
    std::vector<ColorMoments> parts(n_parts + 1);  // the last one stays empty
    for (const ColoredPoint& point : points) parts[random() % n_parts].add(point.color, point.place);
    ColorMoments merged;
    for (const ColorMoments& part : parts) merged += part;
    expect_same_bits(merged, whole);
  }
}

TEST(ColorMoments, PartsAreAtOnePlaceOnlyTogether) {
  const ColorMoments here = moments_of({{{1, 2, 3}, {0, 0, 0}}, {{4, 5, 6}, {0, 0, 0}}});
  const ColorMoments there = moments_of({{{1, 2, 3}, {1, 0, 0}}});
  for (const auto& [second, is_one] : {std::pair{here, true}, {there, false}, {ColorMoments(), true}}) {
    ColorMoments merged;
    merged += here;
    merged += second;
    EXPECT_EQ(merged.one_place(), is_one);
    ColorMoments reversed = second;
    reversed += here;
    EXPECT_EQ(reversed.one_place(), is_one);
  }
}

}  // namespace color_moments_test
}  // namespace cmap
