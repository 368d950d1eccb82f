#include <algorithm>
#include <cmath>

#include "metrics/measured.hpp"

namespace cmap {
namespace median_color_distance_test {

using test::number;

Record median(const test::Clouds& clouds) { return test::measured(catalog::median_color_distance, clouds); }

/// Distances 0.2, 0.4 and 1 one way; the far fourth reference point is 1 away from the third estimated one.
TEST(MedianColorDistance, HandComputed) {
  const test::Clouds clouds{
      test::cloud_of({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {29, 0, 0}}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}),
      test::cloud_of({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}, {{51, 0, 0}, {0, 102, 0}, {0, 0, 255}})};
  const Record found = median(clouds);
  EXPECT_DOUBLE_EQ(number(found, "estimate_to_reference"), 0.4);
  EXPECT_DOUBLE_EQ(number(found, "reference_to_estimate"), 0.7);  // of 0.2, 0.4, 1, 1
  EXPECT_DOUBLE_EQ(*found.value, 0.55);
}

TEST(MedianColorDistance, EqualsTheDefinition) {
  const test::Clouds clouds = test::two_sheets();
  std::vector<double> distances;
  const auto nearest = test::nearest_by_definition(clouds.estimate, clouds.reference);
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    distances.push_back(
        (test::unit_color(clouds.estimate, i) - test::unit_color(clouds.reference, nearest[i].index)).norm());
  }
  std::ranges::sort(distances);
  const std::size_t half = distances.size() / 2;
  EXPECT_NEAR_RELATIVE(number(median(clouds), "estimate_to_reference"), 0.5 * (distances[half - 1] + distances[half]),
                       test::kSummation);
}

/// Almost half of the colors may be wrong.
TEST(MedianColorDistance, IsNotMovedByTheFewWrong) {
  const PointCloud map = test::two_sheets(1001, 10).reference;
  PointCloud painted = map;
  auto& colors = std::get<Array<Rgb8>>(painted.colors);
  for (std::size_t i = 0; i < 500; ++i) {
    for (auto& channel : colors[i]) channel = static_cast<std::uint8_t>(255 - channel);
  }
  EXPECT_EQ(*median({map, painted}).value, 0.0);
  EXPECT_GT(*test::measured(catalog::color_distance, test::Clouds{map, painted}).value, 0.1);
}

TEST(MedianColorDistance, PointsWithoutColorAreLeftOut) {
  test::Clouds clouds{test::cloud_of({{0, 0, 0}, {9, 0, 0}}), test::cloud_of({{0, 0, 0}, {9, 0, 0}})};
  clouds.reference.colors = Array<RgbF>{{0, 0, 0}, {NAN, NAN, NAN}};
  clouds.estimate.colors = Array<RgbF>{{0.5f, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(*median(clouds).value, 0.5);
  EXPECT_EQ(number(median(clouds), "n_without_color_reference"), 1);
  clouds.estimate.colors = Array<RgbF>{{NAN, NAN, NAN}, {1, 1, 1}};
  EXPECT_TRUE(std::isnan(*median(clouds).value));
}

}  // namespace median_color_distance_test
}  // namespace cmap
