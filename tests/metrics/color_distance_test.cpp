#include "cmap/metrics/color_distance.hpp"

#include <cmath>
#include <numbers>

#include "metrics/map_pairs.hpp"

namespace cmap {
namespace {

const double kSqrt3 = std::numbers::sqrt3;

double value(const test::Clouds& clouds, const ColorDistanceOptions& options = {}) {
  return color_distance(clouds.pair(), options).value();
}

/// Two points each; the nearest of both reference points is the first estimated one where the second is far.
test::Clouds two_pairs() {
  return {test::cloud_of({{0, 0, 0}, {10, 0, 0}}, {{0, 0, 0}, {255, 255, 255}}),
          test::cloud_of({{1, 0, 0}}, {{51, 0, 0}})};
}

TEST(ColorDistance, HandComputed) {
  const ColorDistance cd = color_distance(two_pairs().pair());
  EXPECT_DOUBLE_EQ(cd.estimate_to_reference.mean, 0.2);
  EXPECT_DOUBLE_EQ(cd.reference_to_estimate.mean, 0.5 * (0.2 + std::sqrt(0.64 + 2.0)));
  EXPECT_DOUBLE_EQ(cd.value(), 0.5 * (0.2 + 0.5 * (0.2 + std::sqrt(2.64))));
  EXPECT_EQ(cd.estimate_to_reference.n, 1U);
  EXPECT_EQ(cd.reference_to_estimate.n, 2U);
  EXPECT_EQ(cd.reference_to_estimate.n_unmatched, 0U);
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
  const ColorDistance cd = color_distance(clouds.pair());
  EXPECT_NEAR_RELATIVE(cd.estimate_to_reference.mean, directed(clouds.estimate, clouds.reference), test::kSummation);
  EXPECT_NEAR_RELATIVE(cd.reference_to_estimate.mean, directed(clouds.reference, clouds.estimate), test::kSummation);
}

/// Pairs without both colors are left out, and everything else stays as it was.
TEST(ColorDistance, PointsWithoutColorAreLeftOut) {
  const float nan = NAN;
  test::Clouds clouds{test::cloud_of({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}),
                      test::cloud_of({{0.25f, 0, 0}, {10.25f, 0, 0}, {20.25f, 0, 0}})};
  clouds.reference.colors = Array<RgbF>{{0, 0, 0}, {nan, nan, nan}, {0.5f, 0.25f, 1}};
  clouds.estimate.colors = Array<RgbF>{{0.5f, 0, 0}, {0, 0, 0}, {nan, nan, nan}};
  const MapPair pair = clouds.pair();
  EXPECT_EQ(pair.reference.n_without_color, 1U);
  const ColorDistance cd = color_distance(pair);
  for (const DirectedColorDistance& direction : {cd.estimate_to_reference, cd.reference_to_estimate}) {
    EXPECT_EQ(direction.mean, 0.5);
    EXPECT_EQ(direction.n, 1U);
    EXPECT_EQ(direction.n_unmatched, 2U);
  }
  EXPECT_NEAR(color_psnr(pair).psnr_db().x(), -20.0 * std::log10(0.2126 * 0.5), 1e-12);
  EXPECT_EQ(delta_e(pair.estimate_to_reference(), 1.0).n, 1U);
  EXPECT_TRUE(std::isfinite(delta_e(pair.estimate_to_reference(), 1.0).p95));
  EXPECT_EQ(exposure_gains(pair, 1.0).n_pairs, 1U);
  clouds.estimate.colors = Array<RgbF>{{nan, nan, nan}, {0, 0, 0}, {nan, nan, nan}};
  EXPECT_TRUE(std::isnan(value(clouds)));
  EXPECT_TRUE(std::isnan(color_psnr(clouds.pair()).psnr_db().x()));
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
  const auto gated = [](double max_distance_m) {
    ColorDistanceOptions options;
    options.max_distance_m = max_distance_m;
    return color_distance(two_pairs().pair(), options);
  };
  EXPECT_DOUBLE_EQ(gated(1.0).value(), 0.2);
  EXPECT_EQ(gated(1.0).reference_to_estimate.n, 1U);
  EXPECT_EQ(gated(1.0).reference_to_estimate.n_unmatched, 1U);
  EXPECT_TRUE(std::isnan(gated(0.999).value()));
  EXPECT_EQ(gated(0.999).estimate_to_reference.n, 0U);
  EXPECT_EQ(gated(0.999).estimate_to_reference.n_unmatched, 1U);
}

TEST(ColorDistance, RangesAreHalfOpenAndAddUp) {
  const MapPair pair = test::two_sheets().pair();
  const ColorDistance all = color_distance(pair);
  double sum = 0.0;
  std::uint64_t n = 0;
  double low = -1.0;
  for (double high : {0.05, 0.2, 0.5, 1000.0}) {
    const DirectedColorDistance part = color_distance(pair, {low, high}).reference_to_estimate;
    ASSERT_GT(part.n, 0U);
    sum += part.mean * static_cast<double>(part.n);
    n += part.n;
    low = high;
  }
  EXPECT_EQ(n, all.reference_to_estimate.n);
  EXPECT_NEAR_RELATIVE(sum / static_cast<double>(n), all.reference_to_estimate.mean, test::kSummation);
  // Distances of exactly 1 m are in (lo, 1], not in (1, hi].
  EXPECT_EQ(color_distance(two_pairs().pair(), {0.5, 1.0}).estimate_to_reference.n, 1U);
  EXPECT_EQ(color_distance(two_pairs().pair(), {1.0, 2.0}).estimate_to_reference.n, 0U);
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

TEST(ColorDistance, SameBitsForAnyNumberOfThreads) {
  const MapPair pair = test::two_sheets(150000, 140000).pair();
  const double many = color_distance(pair).value();
  const ThreadLimit limit(1);
  EXPECT_EQ(color_distance(pair).value(), many);
}

TEST(ColorDistance, NeedsColorsInBothMaps) {
  test::Clouds clouds = test::two_sheets(10, 10);
  clouds.estimate.colors = std::monostate{};
  const MapPair pair = clouds.pair();
  EXPECT_THROW(color_distance(pair), std::invalid_argument);
  EXPECT_THROW(exposure_gains(pair, 1.0), std::invalid_argument);
  EXPECT_THROW(color_psnr(pair), std::invalid_argument);
  EXPECT_THROW(delta_e(pair.estimate_to_reference(), 1.0), std::invalid_argument);
}

TEST(ColorFidelity, HandComputed) {
  EXPECT_EQ(color_fidelity_db(1.0), 0.0);
  EXPECT_DOUBLE_EQ(color_fidelity_db(0.1), 20.0);
  EXPECT_DOUBLE_EQ(color_fidelity_db(kSqrt3), -10.0 * std::log10(3.0));
  EXPECT_EQ(color_fidelity_db(0.0), INFINITY);
}

TEST(ExposureGains, UndoAnExactGain) {
  test::Clouds clouds{test::sheet_cloud(200, 2), test::sheet_cloud(200, 2)};
  Array<Rgb8> full(200), dim(200);
  for (std::size_t i = 0; i < 200; ++i) {
    const auto v = static_cast<std::uint8_t>(i % 10);
    full[i] = {static_cast<std::uint8_t>(20 * v), static_cast<std::uint8_t>(25 * v), v};
    dim[i] = {static_cast<std::uint8_t>(10 * v), static_cast<std::uint8_t>(5 * v), v};
  }
  clouds.reference.colors = full;
  clouds.estimate.colors = dim;
  const MapPair pair = clouds.pair();
  const ExposureGains gains = exposure_gains(pair, 0.5);
  EXPECT_EQ(gains.gain, Eigen::Vector3d(2, 5, 1));  // black pairs have no ratio
  EXPECT_EQ(gains.n_pairs, 200U);
  ColorDistanceOptions options;
  options.estimate_gain = gains.gain;
  EXPECT_GT(color_distance(pair).value(), 0.1);
  EXPECT_EQ(color_distance(pair, options).estimate_to_reference.mean, 0.0);
  EXPECT_EQ(color_distance(pair, options).reference_to_estimate.mean, 0.0);
}

TEST(ExposureGains, AreMediansOverTheNearPairsWithoutZeros) {
  const PointCloud reference =
      test::cloud_of({{0, 0, 0}, {5, 0, 0}, {9, 0, 0}, {20, 0, 0}}, {{100, 0, 7}, {200, 9, 0}, {50, 9, 0}, {1, 1, 1}});
  const PointCloud estimate = test::cloud_of({{0.5f, 0, 0}, {5, 0, 0}, {9, 0, 0}, {21, 0, 0}},
                                             {{50, 8, 0}, {50, 3, 0}, {1, 0, 7}, {255, 255, 255}});
  const ExposureGains gains = exposure_gains(test::Clouds{reference, estimate}.pair(), 0.5);
  EXPECT_EQ(gains.n_pairs, 3U);
  EXPECT_EQ(gains.gain.x(), 4.0);  // of 2, 4, 50
  EXPECT_EQ(gains.gain.y(), 3.0);  // of 9/3 alone
  EXPECT_TRUE(std::isnan(gains.gain.z()));
  EXPECT_EQ(exposure_gains(test::Clouds{reference, estimate}.pair(), 1.0).n_pairs, 4U);
}

TEST(ColorPsnr, HandComputed) {
  const auto psnr_of = [](Rgb8 reference, Rgb8 estimate) {
    return color_psnr(
        test::Clouds{test::cloud_of({{0, 0, 0}}, {reference}), test::cloud_of({{0, 0, 0}}, {estimate})}.pair());
  };
  // A gray step of 0.2 has no chroma.
  const Eigen::Vector3d gray = psnr_of({100, 100, 100}, {151, 151, 151}).psnr_db();
  EXPECT_NEAR_RELATIVE(gray.x(), 10.0 * std::log10(25.0), test::kSummation);
  EXPECT_EQ(gray.y(), INFINITY);
  EXPECT_EQ(gray.z(), INFINITY);
  const ColorPsnr red = psnr_of({0, 0, 0}, {255, 0, 0});
  EXPECT_DOUBLE_EQ(red.mse_estimate_to_reference.x(), 0.2126 * 0.2126);
  EXPECT_DOUBLE_EQ(red.mse_estimate_to_reference.y(), 0.1146 * 0.1146);
  EXPECT_DOUBLE_EQ(red.mse_reference_to_estimate.z(), 0.25);
  EXPECT_EQ(psnr_of({9, 8, 7}, {9, 8, 7}).psnr_db(), Eigen::Vector3d::Constant(INFINITY));
}

TEST(ColorPsnr, TakesTheWorseDirectionOfEachChannel) {
  // The far white reference point is found in one direction only: mse 0 against 1/2.
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}, {10, 0, 0}}, {{0, 0, 0}, {255, 255, 255}}),
                            test::cloud_of({{0, 0, 0}}, {{0, 0, 0}})};
  const ColorPsnr psnr = color_psnr(clouds.pair());
  EXPECT_EQ(psnr.mse_estimate_to_reference.x(), 0.0);
  EXPECT_NEAR(psnr.psnr_db().x(), 10.0 * std::log10(2.0), 1e-12);
  const ColorPsnr other = color_psnr(test::Clouds{clouds.estimate, clouds.reference}.pair());
  EXPECT_EQ(other.psnr_db().x(), psnr.psnr_db().x());
}

TEST(DeltaE, HandComputed) {
  const test::Clouds clouds{
      test::cloud_of({{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}, {{255, 255, 255}, {90, 0, 0}, {0, 0, 0}}),
      test::cloud_of({{0, 0, 0}, {4, 0, 0.5f}, {8, 0, 0.6f}}, {{0, 0, 0}, {90, 0, 0}, {255, 0, 0}})};
  const DeltaEStats found = delta_e(clouds.pair().estimate_to_reference(), 0.5);
  // Black and white are L* 0 and 100 apart; the third pair is too far. S_L of that pair is 1.
  EXPECT_EQ(found.n, 2U);
  EXPECT_NEAR(found.mean, 50.0, 1e-9);
  EXPECT_NEAR(found.median, 50.0, 1e-9);
  EXPECT_NEAR(found.p95, 95.0, 1e-9);
  EXPECT_EQ(delta_e(clouds.pair().estimate_to_reference(), 0.6000001).n, 3U);
}

TEST(DeltaE, EqualsTheDefinitionInBothDirections) {
  const test::Clouds clouds = test::two_sheets();
  const MapPair pair = clouds.pair();
  const auto nearest = test::nearest_by_definition(clouds.reference, clouds.estimate);
  double sum = 0.0;
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i].distance_m > 0.3) continue;
    sum += delta_e_2000(srgb_to_lab(test::unit_color(clouds.reference, i)),
                        srgb_to_lab(test::unit_color(clouds.estimate, nearest[i].index)));
    ++n;
  }
  const DeltaEStats found = delta_e(pair.reference_to_estimate(), 0.3);
  EXPECT_EQ(found.n, n);
  EXPECT_NEAR_RELATIVE(found.mean, sum / static_cast<double>(n), test::kSummation);
  EXPECT_LT(found.median, found.p95);
}

TEST(DeltaE, WithoutPairsIsMissing) {
  const DeltaEStats none = delta_e(two_pairs().pair().estimate_to_reference(), 0.5);
  EXPECT_EQ(none.n, 0U);
  EXPECT_TRUE(std::isnan(none.mean));
  EXPECT_TRUE(std::isnan(none.median));
}

TEST(DeltaE, OfAMapAndItselfIsZero) {
  const PointCloud cloud = test::painted_triplicates(200);
  const DeltaEStats found = delta_e(test::Clouds{cloud, cloud}.pair().estimate_to_reference(), 0.0);
  EXPECT_EQ(found.n, 600U);
  EXPECT_EQ(found.p95, 0.0);
}

}  // namespace
}  // namespace cmap
