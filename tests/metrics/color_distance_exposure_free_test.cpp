#include <cmath>

#include "cmap/metrics/exposure_gains.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace color_distance_exposure_free_test {

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
  EXPECT_GT(*test::measured(catalog::color_distance, pair).value, 0.1);
  const Record found = test::measured(catalog::color_distance_exposure_free, pair);
  EXPECT_EQ(test::number(found, "estimate_to_reference"), 0.0);
  EXPECT_EQ(test::number(found, "reference_to_estimate"), 0.0);
  EXPECT_EQ(test::number(found, "n_pairs"), 200);
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

TEST(ExposureGains, NeedColorsInBothMaps) {
  test::Clouds clouds = test::two_sheets(10, 10);
  clouds.estimate.colors = std::monostate{};
  EXPECT_THROW(exposure_gains(clouds.pair(), 1.0), std::invalid_argument);
}

/// What the gain does not explain is the color distance of the maps with it.
TEST(ColorDistanceExposureFree, HandComputed) {
  test::Clouds clouds{test::cloud_of({{0, 0, 0}, {5, 0, 0}, {9, 0, 0}}),
                      test::cloud_of({{0, 0, 0}, {5, 0, 0}, {9, 0, 0}})};
  clouds.reference.colors = Array<RgbF>{{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}, {1, 0.5f, 0.5f}};
  clouds.estimate.colors = Array<RgbF>(3, RgbF{0.25f, 0.5f, 0.5f});
  const Record found = test::measured(catalog::color_distance_exposure_free, clouds);
  // Gains 2, 2, 4: the median brings two pairs together and leaves 1 - 0.5 of the third.
  EXPECT_DOUBLE_EQ(*found.value, 0.5 / 3.0);
}

}  // namespace color_distance_exposure_free_test
}  // namespace cmap
