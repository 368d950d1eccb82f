#include <algorithm>
#include <cmath>

#include "metrics/measured.hpp"

namespace cmap {
namespace fitness_test {

using test::at_threshold;
using test::measured;
using test::number;

Record fitness(const Array<double>& sq_dist, std::vector<double> thresholds_m) {
  return measured(catalog::fitness, test::pair_with(sq_dist), test::with_thresholds(std::move(thresholds_m)));
}

TEST(Fitness, ThresholdsAreInclusiveInAnyOrder) {
  const Record found = fitness({0.25, 1.0, 4.0}, {1.0, 2.0, 0.5, 0.49});
  const std::vector<double> n{2, 3, 1, 0};
  EXPECT_EQ(number(found, "n_points"), 3);
  for (std::size_t t = 0; t < n.size(); ++t) {
    EXPECT_EQ(number(at_threshold(found, t), "n"), n[t]) << t;
    EXPECT_EQ(*at_threshold(found, t).value, n[t] / 3.0) << t;
  }
  EXPECT_EQ(at_threshold(found, 3).threshold_m, 0.49);
}

TEST(Fitness, ThresholdsAreComparedWithTheDistanceNotItsSquare) {
  // 0.1 x 0.1 is above the square of a tenth, its root is again the double 0.1.
  EXPECT_EQ(*at_threshold(fitness({0.1 * 0.1}, {0.1}), 0).value, 1.0);
  EXPECT_EQ(*at_threshold(fitness({std::nextafter(0.01, 1.0) * 1.0001}, {0.1}), 0).value, 0.0);
}

TEST(Fitness, TheRoundingIsTwoStepsOfTheLargestOffset) {
  // 2^-20 m is the step from 8 to 16 m: 12.5 m apart in z by 1 m and so many steps.
  const auto share = [](double steps) {
    const test::Clouds clouds{test::cloud_of({{-12.5f, 0, 0}}),
                              test::cloud_of({{-12.5f, 0, static_cast<float>(1.0 + steps * 0x1p-20)}})};
    return *at_threshold(measured(catalog::fitness, clouds, test::with_thresholds({1.0})), 0).value;
  };
  EXPECT_EQ(share(2.0), 1.0);
  EXPECT_EQ(share(2.25), 0.0);
}

TEST(Fitness, OfAMapAndItselfIsOne) {
  for (const PointCloud& cloud : {test::two_sheets().reference, test::painted_triplicates(500)}) {
    const Record same = measured(catalog::fitness, test::Clouds{cloud, cloud});
    for (const Record& level : same.list("per_threshold")) EXPECT_EQ(*level.value, 1.0);
  }
}

TEST(Fitness, SharesRiseWithTheThreshold) {
  std::vector<double> thresholds;
  for (int i = 1; i <= 100; ++i) thresholds.push_back(0.012 * i);
  const Record found = fitness(test::random_squares(5000, 2), thresholds);
  for (std::size_t t = 1; t < thresholds.size(); ++t) {
    EXPECT_GE(*at_threshold(found, t).value, *at_threshold(found, t - 1).value);
  }
  EXPECT_LT(*at_threshold(found, 0).value, *at_threshold(found, 99).value);
}

/// More bands than a byte counts.
TEST(Fitness, TakesAnyNumberOfThresholds) {
  std::vector<double> thresholds;
  for (int i = 1; i <= 1000; ++i) thresholds.push_back(0.001 * i);
  const Array<double> sq_dist = test::random_squares(5000, 6);
  const Record found = fitness(sq_dist, thresholds);
  for (const std::size_t t : {0u, 99u, 254u, 255u, 256u, 599u, 999u}) {
    const auto n = std::ranges::count_if(sq_dist, [&](double sq) { return std::sqrt(sq) <= thresholds[t]; });
    EXPECT_EQ(number(at_threshold(found, t), "n"), static_cast<double>(n)) << t;
  }
}

}  // namespace fitness_test
}  // namespace cmap
