#include <cmath>
#include <numbers>

#include "cmap/core/execution.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace color_distance_test {

const double kSqrt3 = std::numbers::sqrt3;

using test::number;

Record color_distance(const test::Clouds& clouds, std::optional<double> max_distance_m = {}) {
  MetricOptions options;
  options.color_max_distance_m = max_distance_m;
  return test::measured(catalog::color_distance, clouds, options);
}

double value(const test::Clouds& clouds) { return *color_distance(clouds).value; }

/// Two points each; the nearest of both reference points is the first estimated one where the second is far.
test::Clouds two_pairs() {
  return {test::cloud_of({{0, 0, 0}, {10, 0, 0}}, {{0, 0, 0}, {255, 255, 255}}),
          test::cloud_of({{1, 0, 0}}, {{51, 0, 0}})};
}

TEST(ColorDistance, HandComputed) {
  const Record cd = color_distance(two_pairs());
  EXPECT_DOUBLE_EQ(number(cd, "estimate_to_reference"), 0.2);
  EXPECT_DOUBLE_EQ(number(cd, "reference_to_estimate"), 0.5 * (0.2 + std::sqrt(0.64 + 2.0)));
  EXPECT_DOUBLE_EQ(*cd.value, 0.5 * (0.2 + 0.5 * (0.2 + std::sqrt(2.64))));
  EXPECT_DOUBLE_EQ(number(cd, "value_8bit"), 255.0 * *cd.value);
  EXPECT_EQ(number(cd, "n_estimate"), 1);
  EXPECT_EQ(number(cd, "n_reference"), 2);
  EXPECT_FALSE(cd.number("n_unmatched_reference")) << "nothing was left out";
}

TEST(ColorDistance, EqualsTheDefinition) {
  const test::Clouds clouds = test::two_sheets();
  const auto directed = [](const PointCloud& from, const PointCloud& to) {
    double sum = 0.0;
    const auto nearest = test::nearest_by_definition(from, to);
    for (std::size_t i = 0; i < from.size(); ++i) {
      sum += (test::unit_color(from, i) - test::unit_color(to, nearest[i].index)).norm();
    }
    return sum / static_cast<double>(from.size());
  };
  const Record cd = color_distance(clouds);
  EXPECT_NEAR_RELATIVE(number(cd, "estimate_to_reference"), directed(clouds.estimate, clouds.reference),
                       test::kSummation);
  EXPECT_NEAR_RELATIVE(number(cd, "reference_to_estimate"), directed(clouds.reference, clouds.estimate),
                       test::kSummation);
}

/// Pairs without both colors are left out, and everything else stays as it was.
TEST(ColorDistance, PointsWithoutColorAreLeftOut) {
  const float nan = NAN;
  test::Clouds clouds{test::cloud_of({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}),
                      test::cloud_of({{0.25f, 0, 0}, {10.25f, 0, 0}, {20.25f, 0, 0}})};
  clouds.reference.colors = Array<RgbF>{{0, 0, 0}, {nan, nan, nan}, {0.5f, 0.25f, 1}};
  clouds.estimate.colors = Array<RgbF>{{0.5f, 0, 0}, {0, 0, 0}, {nan, nan, nan}};
  EXPECT_EQ(clouds.pair().reference.n_without_color, 1U);
  const Record cd = color_distance(clouds);
  for (const char* direction : {"estimate_to_reference", "reference_to_estimate"})
    EXPECT_EQ(number(cd, direction), 0.5);
  for (const char* map : {"estimate", "reference"}) {
    EXPECT_EQ(number(cd, std::string("n_") + map), 1);
    EXPECT_EQ(number(cd, std::string("n_unmatched_") + map), 2);
    EXPECT_EQ(number(cd, std::string("n_without_color_") + map), 1);
  }
  EXPECT_NEAR(*test::measured(catalog::color_psnr, clouds).value, -20.0 * std::log10(0.2126 * 0.5), 1e-12);
  const Record delta_e = test::measured(catalog::delta_e, clouds);
  EXPECT_EQ(number(delta_e, "estimate_to_reference.n"), 1);
  EXPECT_TRUE(std::isfinite(number(delta_e, "estimate_to_reference.p95")));
  EXPECT_EQ(exposure_gains(clouds.pair(), 1.0).n_pairs, 1U);
  clouds.estimate.colors = Array<RgbF>{{nan, nan, nan}, {0, 0, 0}, {nan, nan, nan}};
  EXPECT_TRUE(std::isnan(value(clouds)));
  EXPECT_TRUE(std::isnan(*test::measured(catalog::color_psnr, clouds).value));
}

TEST(ColorDistance, OfAMapAndItselfIsZero) {
  for (const PointCloud& cloud : {test::two_sheets().reference, test::painted_triplicates(300)}) {
    EXPECT_EQ(value({cloud, cloud}), 0.0);
  }
}

TEST(ColorDistance, CoincidentPointsHaveTheLowestIndexAsNeighbor) {
  // The white point's nearest is the black one in its place.
  const PointCloud both = test::cloud_of({{1, 2, 3}, {1, 2, 3}}, {{0, 0, 0}, {255, 255, 255}});
  EXPECT_DOUBLE_EQ(value({both, both}), kSqrt3 / 2.0);
}

TEST(ColorDistance, OfAConstantShiftIsThatTimesSqrt3) {
  const PointCloud sheet = test::sheet_cloud(500, 1);
  for (int shift : {1, 51, 100, 155}) {
    test::Clouds clouds{sheet, sheet};
    Array<Rgb8> dark(sheet.size()), light(sheet.size());
    for (std::size_t i = 0; i < sheet.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        dark[i][c] = static_cast<std::uint8_t>((i + 7 * c) % 100);
        light[i][c] = static_cast<std::uint8_t>(dark[i][c] + shift);
      }
    }
    clouds.reference.colors = dark;
    clouds.estimate.colors = light;
    EXPECT_NEAR_RELATIVE(value(clouds), shift / 255.0 * kSqrt3, test::kSummation);
  }
}

TEST(ColorDistance, StorageDoesNotMatter) {
  test::Clouds clouds = test::two_sheets(300, 200);
  const double expected = value(clouds);
  const auto colors = std::get<Array<Rgb8>>(clouds.estimate.colors);
  Array<Rgb16> wide(colors.size());
  Array<RgbF> unit(colors.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      wide[i][c] = static_cast<std::uint16_t>(257 * colors[i][c]);
      unit[i][c] = static_cast<float>(colors[i][c]) / 255.0f;
    }
  }
  clouds.estimate.colors = wide;
  EXPECT_DOUBLE_EQ(value(clouds), expected);
  clouds.estimate.colors = unit;
  EXPECT_NEAR(value(clouds), expected, 1e-7);  // a float in [0,1] is rounded to 6e-8
}

TEST(ColorDistance, TheGateIsInclusiveAndCountsWhatItLeavesOut) {
  const auto gated = [](double max_distance_m) { return color_distance(two_pairs(), max_distance_m); };
  EXPECT_DOUBLE_EQ(*gated(1.0).value, 0.2);
  EXPECT_EQ(number(gated(1.0), "n_reference"), 1);
  EXPECT_EQ(number(gated(1.0), "n_unmatched_reference"), 1);
  EXPECT_TRUE(std::isnan(*gated(0.999).value));
  EXPECT_EQ(number(gated(0.999), "n_estimate"), 0);
  EXPECT_EQ(number(gated(0.999), "n_unmatched_estimate"), 1);
}

TEST(ColorDistance, IsInvariantUnderMotionPermutationTranslationAndScale) {
  const test::Clouds clouds = test::two_sheets();
  const double expected = value(clouds);
  // The same pairs in every case: no two neighbors are so nearly equal that rounding swaps them.
  EXPECT_NEAR_RELATIVE(value(test::moved(clouds, test::rigid_motion())), expected, test::kSummation);
  EXPECT_NEAR_RELATIVE(value(test::permuted(clouds)), expected, test::kSummation);
  EXPECT_NEAR_RELATIVE(value(test::moved(clouds, test::translation({1e6, 1e6, 0}))), expected, test::kSummation);
  EXPECT_NEAR_RELATIVE(value(test::moved(clouds, test::scaling(3.7))), expected, test::kSummation);
}

TEST(ColorDistance, SameBitsForAnyNumberOfThreadsAndOrderOfPoints) {
  const test::Clouds clouds = test::two_sheets(150000, 140000);
  const double many = value(clouds);
  EXPECT_EQ(value(test::permuted(clouds)), many);
  const ExecutionScope limit({.threads = 1});
  EXPECT_EQ(value(clouds), many);
}

}  // namespace color_distance_test
}  // namespace cmap
