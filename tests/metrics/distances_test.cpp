#include "cmap/metrics/distances.hpp"

#include <cmath>

#include "metrics/map_pairs.hpp"

namespace cmap {
namespace {

using Doubles = std::vector<double>;

const Doubles kThresholds_m{0.2, 0.1, 0.08, 0.05, 0.01};

double sq(double v) { return v * v; }

DistanceStats stats_of(const Array<double>& sq_dist, const Doubles& thresholds_m = kThresholds_m,
                       double truncation_m = 1.0) {
  return distance_stats(sq_dist, thresholds_m, truncation_m);
}

Array<double> random_squares(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  Array<double> sq_dist(n);
  for (double& sq : sq_dist) sq = std::pow(test::uniform(random), 6.0);
  return sq_dist;
}

TEST(DistanceStats, HandComputed) {
  const DistanceStats stats = stats_of({0.0625, 9.0}, {3.0, 0.25, 0.125});
  EXPECT_EQ(stats.n, 2U);
  EXPECT_EQ(stats.mean_m, 1.625);
  EXPECT_EQ(stats.mean_sq_m2, 4.53125);
  EXPECT_EQ(stats.mean_truncated_m, 0.625);  // (0.25 + 1) / 2
  EXPECT_EQ(stats.max_m, 3.0);
  EXPECT_DOUBLE_EQ(stats.p95_m, 2.8625);
  EXPECT_DOUBLE_EQ(stats.p99_m, 2.9725);
  ASSERT_EQ(stats.within.size(), 3U);
  EXPECT_EQ(stats.within[0].n, 2U);
  EXPECT_EQ(stats.within[0].mean_m, 1.625);
  EXPECT_EQ(stats.within[0].rmse_m, std::sqrt(4.53125));
  EXPECT_EQ(stats.within[0].median_m, 1.625);
  EXPECT_EQ(stats.within[1].n, 1U);
  EXPECT_EQ(stats.within[1].rmse_m, 0.25);
  EXPECT_EQ(stats.share_within(0), 1.0);
  EXPECT_EQ(stats.share_within(1), 0.5);
  EXPECT_EQ(stats.share_within(2), 0.0);
}

TEST(DistanceStats, NothingWithinIsMissing) {
  const WithinThreshold within = stats_of({1.0}, {0.5}).within.front();
  EXPECT_EQ(within.n, 0U);
  EXPECT_TRUE(std::isnan(within.mean_m));
  EXPECT_TRUE(std::isnan(within.rmse_m));
  EXPECT_TRUE(std::isnan(within.median_m));
}

TEST(DistanceStats, ThresholdsAreInclusiveInAnyOrder) {
  const DistanceStats stats = stats_of({0.25, 1.0, 4.0}, {1.0, 2.0, 0.5, 1.0, 0.49});
  const std::array<std::uint64_t, 5> expected{2, 3, 1, 2, 0};
  for (std::size_t t = 0; t < expected.size(); ++t) EXPECT_EQ(stats.within[t].n, expected[t]) << t;
  EXPECT_EQ(stats.within[0].threshold_m, 1.0);
  EXPECT_EQ(stats.within[4].threshold_m, 0.49);
}

TEST(DistanceStats, ThresholdsAreComparedWithTheDistanceNotItsSquare) {
  // 0.1 x 0.1 is above the square of a tenth, its root is again the double 0.1.
  const double sq = 0.1 * 0.1;
  EXPECT_EQ(stats_of({sq}, {0.1}).within[0].n, 1U);
  EXPECT_EQ(stats_of({std::nextafter(0.01, 1.0) * 1.0001}, {0.1}).within[0].n, 0U);
}

/// A distance above a threshold by no more than its own rounding counts as at it; the others' is not asked for.
TEST(DistanceStats, RoundingBelongsToTheThreshold) {
  const Array<double> sq_dist{sq(0.1), sq(0.1 + 3e-7), sq(0.1 + 3e-7), sq(0.1 + 3e-6), sq(0.2 + 1e-7), sq(0.3)};
  const std::array<double, 6> rounding{0, 4e-7, 2e-7, 4e-7, 2e-7, 1};
  std::vector<std::size_t> asked;
  const auto of_pair = [&](std::size_t i) {
    asked.push_back(i);
    return rounding[i];
  };
  const DistanceStats stats = distance_stats(sq_dist, Doubles{0.2, 0.1}, 1.0, {4e-7, of_pair});
  EXPECT_EQ(stats.within[0].n, 5U);
  EXPECT_EQ(stats.within[1].n, 2U);
  EXPECT_DOUBLE_EQ(stats.within[1].rmse_m, std::sqrt((sq(0.1) + sq(0.1 + 3e-7)) / 2));
  EXPECT_NEAR(stats.within[1].median_m, 0.1 + 1.5e-7, 1e-12);
  EXPECT_EQ(asked, (std::vector<std::size_t>{1, 2, 4}));
}

TEST(DistanceStats, VoxelCentersATenthApartAreWithinATenth) {
  for (double far : {0.0, 100.0, -3000.0}) {
    test::Clouds clouds;
    for (int i = 0; i < 50; ++i) {
      clouds.reference.positions.push_back(Eigen::Vector3d(far + i, -i, 0.1).cast<float>());
      clouds.estimate.positions.push_back(Eigen::Vector3d(far + i, -i, 0.2).cast<float>());
    }
    clouds.estimate.positions.push_back(Eigen::Vector3d(far, 0.0, 0.2 + 0.003).cast<float>());
    const MapPair pair = clouds.pair();
    const NearestPairs pairs = pair.estimate_to_reference();
    const DistanceStats stats =
        distance_stats(pairs.nearest.sq_dist, Doubles{0.1, 0.099}, 1.0,
                       {pairs.most_rounding_m(), [&](std::size_t slot) { return pairs.rounding_m(slot); }});
    EXPECT_EQ(stats.within[0].n, 50U);
    EXPECT_EQ(stats.within[1].n, 0U);
    std::size_t n_within = 0;
    for (std::size_t slot = 0; slot < pairs.size(); ++slot) n_within += pairs.is_within(slot, 0.1) ? 1 : 0;
    EXPECT_EQ(n_within, 50U);
  }
}

TEST(DistanceStats, TheRoundingIsTwoStepsOfTheLargestOffset) {
  // 2^-20 m is the step from 8 to 16 m: 12.5 m apart in z by 1 m and so many steps.
  const auto is_within = [](double steps) {
    const test::Clouds clouds{test::cloud_of({{-12.5f, 0, 0}}),
                              test::cloud_of({{-12.5f, 0, static_cast<float>(1.0 + steps * 0x1p-20)}})};
    return clouds.pair().estimate_to_reference().is_within(0, 1.0);
  };
  EXPECT_TRUE(is_within(2.0));
  EXPECT_FALSE(is_within(2.25));
}

TEST(DistanceStats, NoDistancesAreRefused) { EXPECT_THROW(stats_of({}), std::invalid_argument); }

TEST(DistanceStats, OneZeroDistance) {
  const DistanceStats stats = stats_of({0.0});
  EXPECT_EQ(stats.mean_m, 0.0);
  EXPECT_EQ(stats.p95_m, 0.0);
  for (std::size_t t = 0; t < kThresholds_m.size(); ++t) EXPECT_EQ(stats.share_within(t), 1.0);
}

/// Statistics of the distances up to a limit, one after the other.
void expect_equals_definition(const WithinThreshold& found, const Array<double>& sq_dist) {
  long double sum = 0.0L, sum_sq = 0.0L;
  std::vector<double> distances;
  for (double sq : sq_dist) {
    const double d = std::sqrt(sq);
    if (d > found.threshold_m) continue;
    distances.push_back(d);
    sum += d;
    sum_sq += sq;
  }
  const auto n = static_cast<long double>(distances.size());
  ASSERT_EQ(found.n, distances.size());
  EXPECT_NEAR_RELATIVE(found.mean_m, static_cast<double>(sum / n), test::kSummation);
  EXPECT_NEAR_RELATIVE(found.rmse_m, static_cast<double>(std::sqrt(sum_sq / n)), test::kSummation);
  std::sort(distances.begin(), distances.end());
  const std::size_t half = distances.size() / 2;
  const double median = distances.size() % 2 == 1 ? distances[half] : 0.5 * (distances[half - 1] + distances[half]);
  EXPECT_DOUBLE_EQ(found.median_m, median);
}

TEST(DistanceStats, EqualTheDefinitionOverManyChunks) {
  const Array<double> sq_dist = random_squares(300001, 1);
  const DistanceStats stats = stats_of(sq_dist, {0.2, 0.01, 0.5, 2.0}, 0.3);
  for (const WithinThreshold& within : stats.within) expect_equals_definition(within, sq_dist);
  EXPECT_EQ(stats.mean_m, stats.within[3].mean_m);  // all are below 2
  long double truncated = 0.0L;
  for (double sq : sq_dist) truncated += std::min(std::sqrt(sq), 0.3);
  EXPECT_NEAR_RELATIVE(stats.mean_truncated_m, static_cast<double>(truncated / 300001.0L), test::kSummation);
  EXPECT_EQ(stats.max_m, std::sqrt(*std::max_element(sq_dist.begin(), sq_dist.end())));
}

TEST(DistanceStats, SharesRiseWithTheThreshold) {
  Doubles thresholds;
  for (int i = 1; i <= 100; ++i) thresholds.push_back(0.012 * i);
  const DistanceStats stats = stats_of(random_squares(5000, 2), thresholds);
  for (std::size_t t = 1; t < thresholds.size(); ++t) {
    EXPECT_GE(stats.share_within(t), stats.share_within(t - 1));
    EXPECT_GE(stats.within[t].rmse_m, stats.within[t - 1].rmse_m);  // what comes in is farther than all before
  }
  EXPECT_LT(stats.share_within(0), stats.share_within(99));
}

TEST(DistanceStats, ScaleWithTheDistances) {
  const Array<double> sq_dist = random_squares(5000, 3);
  Array<double> doubled = sq_dist;
  for (double& sq : doubled) sq *= 4.0;
  const DistanceStats stats = stats_of(sq_dist, {0.1, 0.25}, 0.5);
  const DistanceStats twice = stats_of(doubled, {0.2, 0.5}, 1.0);
  // Powers of two change no digit.
  EXPECT_EQ(twice.mean_m, 2.0 * stats.mean_m);
  EXPECT_EQ(twice.mean_sq_m2, 4.0 * stats.mean_sq_m2);
  EXPECT_EQ(twice.mean_truncated_m, 2.0 * stats.mean_truncated_m);
  EXPECT_EQ(twice.p99_m, 2.0 * stats.p99_m);
  for (std::size_t t = 0; t < 2; ++t) {
    EXPECT_EQ(twice.within[t].n, stats.within[t].n);
    EXPECT_EQ(twice.within[t].median_m, 2.0 * stats.within[t].median_m);
  }
}

TEST(DistanceStats, SameBitsForAnyNumberOfThreads) {
  const Array<double> sq_dist = random_squares(400000, 4);
  const DistanceStats many = stats_of(sq_dist);
  const ThreadLimit limit(1);
  const DistanceStats one = stats_of(sq_dist);
  EXPECT_EQ(one.mean_m, many.mean_m);
  EXPECT_EQ(one.mean_sq_m2, many.mean_sq_m2);
  EXPECT_EQ(one.within[0].rmse_m, many.within[0].rmse_m);
}

TEST(DistanceStats, OfAMapAndItselfAreZero) {
  for (const PointCloud& cloud : {test::two_sheets().reference, test::painted_triplicates(500)}) {
    const MapPair pair = test::Clouds{cloud, cloud}.pair();
    for (const NearestField* nearest : {&pair.nearest_in_reference, &pair.nearest_in_estimate}) {
      const DistanceStats stats = stats_of(nearest->sq_dist);
      EXPECT_EQ(stats.max_m, 0.0);
      for (std::size_t t = 0; t < kThresholds_m.size(); ++t) {
        EXPECT_EQ(stats.share_within(t), 1.0);
        EXPECT_EQ(stats.within[t].rmse_m, 0.0);
      }
    }
  }
}

TEST(DistanceStats, AppendedEstimatePointsNeverLowerCompleteness) {
  test::Clouds clouds = test::two_sheets();
  const Doubles thresholds{0.1, 0.2, 0.5, 1.0};
  DistanceStats before = stats_of(clouds.pair().nearest_in_estimate.sq_dist, thresholds);
  for (unsigned step = 0; step < 4; ++step) {
    PointCloud more = test::sheet_cloud(400, 20 + step, step == 0 ? 500.0f : 20.0f);  // far ones first
    test::paint(more, step);
    clouds.estimate = test::appended(clouds.estimate, more);
    const DistanceStats after = stats_of(clouds.pair().nearest_in_estimate.sq_dist, thresholds);
    for (std::size_t t = 0; t < thresholds.size(); ++t) EXPECT_GE(after.share_within(t), before.share_within(t));
    if (step > 0) {
      EXPECT_GT(after.share_within(1), before.share_within(1));
    }
    before = after;
  }
}

}  // namespace
}  // namespace cmap
