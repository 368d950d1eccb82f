#include "metrics/measured.hpp"

namespace cmap {
namespace overlap_test {

/// Distances 0.25 and 3 of the estimate's points.
const test::Clouds kTwo{test::cloud_of({{0, 0, 0}, {7, 0, 0}}), test::cloud_of({{0.25f, 0, 0}, {7, 3, 0}})};

TEST(Overlap, HandComputed) {
  const auto overlap = [](double distance_m) {
    return test::measured(catalog::overlap, kTwo, test::with_thresholds({0.1}, distance_m));
  };
  EXPECT_EQ(*overlap(1.0).value, 0.5);
  EXPECT_EQ(test::number(overlap(1.0), "n"), 1);
  EXPECT_EQ(test::number(overlap(1.0), "n_estimate"), 2);
  EXPECT_EQ(*overlap(3.0).value, 1.0) << "inclusive";
  EXPECT_EQ(*overlap(0.2).value, 0.0);
}

/// The overlap distance may stand among the thresholds, below or above them.
TEST(Overlap, IsFitnessAtItsDistance) {
  const MapPair pair = test::two_sheets().pair();
  for (const double distance_m : {0.05, 0.2, 0.3, 2.0}) {
    const MetricOptions options = test::with_thresholds({0.3, 0.2, distance_m == 0.2 ? 0.1 : distance_m}, distance_m);
    const Record fitness = test::measured(catalog::fitness, pair, test::with_thresholds({distance_m}));
    EXPECT_EQ(*test::measured(catalog::overlap, pair, options).value, *test::at_threshold(fitness, 0).value);
  }
}

}  // namespace overlap_test
}  // namespace cmap
