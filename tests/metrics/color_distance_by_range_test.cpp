#include <cmath>

#include "metrics/measured.hpp"

namespace cmap {
namespace color_distance_by_range_test {

/// Pairs 0, 0.05, 0.25 and 1 m apart, of color distances 0.2, 0.4, 0.6 and 1.
test::Clouds four_pairs() {
  return {test::cloud_of({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {30, 0, 0}}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}),
          test::cloud_of({{0, 0, 0}, {10, 0.05f, 0}, {20, 0.25f, 0}, {30, 1, 0}},
                         {{51, 0, 0}, {102, 0, 0}, {153, 0, 0}, {255, 0, 0}})};
}

/// Ranges are (lo, hi], the first with 0.
TEST(ColorDistanceByRange, HandComputed) {
  const std::vector<Record> ranges = test::measured(catalog::color_distance_by_range, four_pairs()).list("per_range");
  ASSERT_EQ(ranges.size(), 5U);
  const std::vector<double> lo{0.0, 0.05, 0.1, 0.2, 0.5}, n{2, 0, 0, 1, 1};
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    EXPECT_EQ(test::number(ranges[i], "lo_m"), lo[i]);
    EXPECT_EQ(test::number(ranges[i], "n_estimate"), n[i]) << i;
    EXPECT_EQ(test::number(ranges[i], "n_reference"), n[i]) << i;
  }
  EXPECT_DOUBLE_EQ(*ranges[0].value, 0.3);
  EXPECT_TRUE(std::isnan(*ranges[1].value));
  EXPECT_DOUBLE_EQ(*ranges[3].value, 0.6);
  EXPECT_DOUBLE_EQ(*ranges[4].value, 1.0);
}

TEST(ColorDistanceByRange, RangesAddUp) {
  const MapPair pair = test::two_sheets().pair();
  const Record all = test::measured(catalog::color_distance, pair);
  double sum = 0.0, n = 0.0;
  for (const Record& range : test::measured(catalog::color_distance_by_range, pair).list("per_range")) {
    const double of_range = test::number(range, "n_reference");
    ASSERT_GT(of_range, 0.0);
    sum += of_range * test::number(range, "reference_to_estimate");
    n += of_range;
  }
  // What lies beyond a meter is in no range.
  double beyond = 0.0, n_beyond = 0.0;
  const NearestPairs pairs = pair.reference_to_estimate();
  for (std::size_t slot = 0; slot < pairs.size(); ++slot) {
    if (pairs.is_within(slot, 1.0)) continue;
    beyond += pairs.color_distance(slot);
    ++n_beyond;
  }
  EXPECT_EQ(n + n_beyond, test::number(all, "n_reference"));
  EXPECT_NEAR_RELATIVE((sum + beyond) / (n + n_beyond), test::number(all, "reference_to_estimate"), test::kSummation);
}

}  // namespace color_distance_by_range_test
}  // namespace cmap
