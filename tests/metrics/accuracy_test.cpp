#include <cmath>

#include "metrics/measured.hpp"

namespace cmap {
namespace accuracy_test {

using test::at_threshold;
using test::measured;
using test::number;

double sq(double v) { return v * v; }

Record accuracy(const Array<double>& sq_dist, std::vector<double> thresholds_m) {
  return measured(catalog::accuracy, test::pair_with(sq_dist), test::with_thresholds(std::move(thresholds_m)));
}

TEST(Accuracy, HandComputed) {
  const Record found = accuracy({0.0625, 9.0}, {3.0, 0.25, 0.125});
  ASSERT_EQ(found.list("per_threshold").size(), 3U);
  EXPECT_EQ(at_threshold(found, 0).threshold_m, 3.0);
  EXPECT_EQ(number(at_threshold(found, 0), "n"), 2);
  EXPECT_EQ(number(at_threshold(found, 0), "mean"), 1.625);
  EXPECT_EQ(*at_threshold(found, 0).value, std::sqrt(4.53125));
  EXPECT_EQ(number(at_threshold(found, 0), "median"), 1.625);
  EXPECT_EQ(number(at_threshold(found, 1), "n"), 1);
  EXPECT_EQ(*at_threshold(found, 1).value, 0.25);
  EXPECT_EQ(number(at_threshold(found, 2), "n"), 0);
}

TEST(Accuracy, NothingWithinIsMissing) {
  const Record within = at_threshold(accuracy({1.0}, {0.5}), 0);
  EXPECT_EQ(number(within, "n"), 0);
  EXPECT_TRUE(std::isnan(*within.value));
  EXPECT_TRUE(std::isnan(number(within, "mean")));
  EXPECT_TRUE(std::isnan(number(within, "median")));
}

/// The distances up to a threshold, one after the other.
void expect_equals_definition(const Record& found, const Array<double>& sq_dist) {
  long double sum = 0.0L, sum_sq = 0.0L;
  std::vector<double> distances;
  for (const double square : sq_dist) {
    const double d = std::sqrt(square);
    if (d > *found.threshold_m) continue;
    distances.push_back(d);
    sum += d;
    sum_sq += square;
  }
  const auto n = static_cast<long double>(distances.size());
  ASSERT_EQ(number(found, "n"), static_cast<double>(distances.size()));
  EXPECT_NEAR_RELATIVE(number(found, "mean"), static_cast<double>(sum / n), test::kLongDoubleSum);
  EXPECT_NEAR_RELATIVE(*found.value, static_cast<double>(std::sqrt(sum_sq / n)), test::kLongDoubleSum);
  std::sort(distances.begin(), distances.end());
  const std::size_t half = distances.size() / 2;
  const double median = distances.size() % 2 == 1 ? distances[half] : 0.5 * (distances[half - 1] + distances[half]);
  EXPECT_DOUBLE_EQ(number(found, "median"), median);
}

TEST(Accuracy, EqualsTheDefinitionOverManyChunks) {
  const Array<double> sq_dist = test::random_squares(300001, 1);
  const Record found = accuracy(sq_dist, {0.2, 0.01, 0.5, 2.0});
  for (const Record& within : found.list("per_threshold")) expect_equals_definition(within, sq_dist);
}

TEST(Accuracy, RisesWithTheThreshold) {
  std::vector<double> thresholds;
  for (int i = 1; i <= 100; ++i) thresholds.push_back(0.012 * i);
  const Record found = accuracy(test::random_squares(5000, 2), thresholds);
  for (std::size_t t = 1; t < thresholds.size(); ++t) {
    EXPECT_GE(*at_threshold(found, t).value, *at_threshold(found, t - 1).value) << "what comes in is farther";
  }
}

TEST(Accuracy, ScalesWithTheDistances) {
  const Array<double> sq_dist = test::random_squares(5000, 3);
  Array<double> doubled = sq_dist;
  for (double& square : doubled) square *= 4.0;
  const Record found = accuracy(sq_dist, {0.1, 0.25}), twice = accuracy(doubled, {0.2, 0.5});
  for (std::size_t t = 0; t < 2; ++t) {
    // Powers of two change digits of what lies below 2^-72 alone.
    EXPECT_DOUBLE_EQ(*at_threshold(twice, t).value, 2.0 * *at_threshold(found, t).value);
    EXPECT_EQ(number(at_threshold(twice, t), "n"), number(at_threshold(found, t), "n"));
    EXPECT_EQ(number(at_threshold(twice, t), "median"), 2.0 * number(at_threshold(found, t), "median"));
  }
}

/// A distance above a threshold by no more than its own rounding counts as at it: 2 steps of float, 2^-20 m from 8 to
/// 16 m.
TEST(Accuracy, RoundingBelongsToTheThreshold) {
  const std::vector<Eigen::Vector3f> places(4, {12.5f, 0, 0});
  MapPair pair = test::Clouds{test::cloud_of(places), test::cloud_of(places)}.pair();
  const double step = 0x1p-20;
  pair.nearest_in_reference.sq_dist = {sq(0.1), sq(0.1 + 1.5 * step), sq(0.1 + 2.5 * step), sq(0.3)};
  const Record within = at_threshold(measured(catalog::accuracy, pair, test::with_thresholds({0.1, 0.2})), 0);
  EXPECT_EQ(number(within, "n"), 2);
  EXPECT_DOUBLE_EQ(*within.value, std::sqrt((sq(0.1) + sq(0.1 + 1.5 * step)) / 2));
  EXPECT_NEAR(number(within, "median"), 0.1 + 0.75 * step, 1e-12);
}

TEST(Accuracy, VoxelCentersATenthApartAreWithinATenth) {
  for (double far : {0.0, 100.0, -3000.0}) {
    test::Clouds clouds;
    for (int i = 0; i < 50; ++i) {
      clouds.reference.positions.push_back(Eigen::Vector3d(far + i, -i, 0.1).cast<float>());
      clouds.estimate.positions.push_back(Eigen::Vector3d(far + i, -i, 0.2).cast<float>());
    }
    clouds.estimate.positions.push_back(Eigen::Vector3d(far, 0.0, 0.2 + 0.003).cast<float>());
    const MapPair pair = clouds.pair();
    const Record found = measured(catalog::accuracy, pair, test::with_thresholds({0.1, 0.099}));
    EXPECT_EQ(number(at_threshold(found, 0), "n"), 50);
    EXPECT_EQ(number(at_threshold(found, 1), "n"), 0);
    const NearestPairs pairs = pair.estimate_to_reference();
    std::size_t n_within = 0;
    for (std::size_t slot = 0; slot < pairs.size(); ++slot) n_within += pairs.is_within(slot, 0.1) ? 1 : 0;
    EXPECT_EQ(n_within, 50U);
  }
}

}  // namespace accuracy_test
}  // namespace cmap
