#include "cmap/colorize/weighted_median.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace cmap {
namespace weighted_median_test {

float median_of(std::vector<WeightedValue> values) { return weighted_median(values); }

TEST(WeightedMedian, OfEqualWeightsIsTheMedian) {
  EXPECT_FLOAT_EQ(median_of({{7, 1}}), 7);
  EXPECT_FLOAT_EQ(median_of({{9, 1}, {1, 1}, {4, 1}}), 4);
  EXPECT_FLOAT_EQ(median_of({{9, 2}, {1, 2}, {4, 2}, {6, 2}}), 5) << "the mean of the two in the middle";
  EXPECT_TRUE(std::isnan(median_of({})));
}

/// By hand: 0 of weight 1 has its place at 0.5, 10 of weight 3 at 1 + 1.5 = 2.5; one half of 4 lies three quarters of
/// the way between them.
TEST(WeightedMedian, IsInterpolatedBetweenPlaces) {
  EXPECT_FLOAT_EQ(median_of({{0, 1}, {10, 3}}), 7.5);
  EXPECT_FLOAT_EQ(median_of({{10, 3}, {0, 1}}), 7.5);
  // Places 0.5, 2, 4.5: one half, 3, lies 0.4 of the way from 2 to 4.5.
  EXPECT_FLOAT_EQ(median_of({{1, 1}, {2, 2}, {7, 3}}), 4);
}

TEST(WeightedMedian, OutliersOfLittleWeightDoNotMatter) {
  const float without = median_of({{0.4f, 1}, {0.5f, 1}, {0.6f, 1}});
  EXPECT_NEAR(median_of({{0.4f, 1}, {0.5f, 1}, {0.6f, 1}, {1e6f, 1e-4f}}), without, 1e-4);
  EXPECT_FLOAT_EQ(median_of({{3, 1e-6f}, {3, 5}, {3, 2}}), 3);
}

}  // namespace weighted_median_test
}  // namespace cmap
