#include "distribution.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "metrics/map_pairs.hpp"

namespace cmap {
namespace distribution_test {

std::uint64_t total(const DirectedDistribution& d) {
  return std::accumulate(d.counts.begin(), d.counts.end(), d.n_beyond);
}

TEST(Distribution, HandComputed) {
  // Estimated points 0.125, 0.375 and 2 m above a reference of three points that are far apart.
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}, {50, 0, 0}, {0, 50, 0}}),
                            test::cloud_of({{0, 0, 0.125f}, {50, 0, 0.375f}, {0, 50, 2}})};
  const Distribution found = distribution_of(clouds.pair(), &NearestPairs::distance_m);
  // The 99th percentile, 1.9675, lies below 2; its round number 2 is divided by 500 bins.
  EXPECT_EQ(found.bin_width, 0.004);
  for (const DirectedDistribution& d : {found.estimate_to_reference, found.reference_to_estimate}) {
    ASSERT_EQ(d.counts.size(), 500u);
    EXPECT_EQ(d.counts[31], 1u);
    EXPECT_EQ(d.counts[93], 1u);
    EXPECT_EQ(d.counts[499], 1u) << "2 m is where the last bin ends";
    EXPECT_EQ(d.n_beyond, 0u);
    EXPECT_EQ(total(d), 3u);
    EXPECT_DOUBLE_EQ(d.p95, 0.375 + 0.9 * (2.0 - 0.375));
  }
}

TEST(Distribution, CountsEveryPointOfBothDirections) {
  const test::Clouds clouds = test::two_sheets();
  const MapPair pair = clouds.pair();
  for (PairError error : {&NearestPairs::distance_m, &NearestPairs::color_distance}) {
    const Distribution found = distribution_of(pair, error);
    EXPECT_EQ(total(found.estimate_to_reference), pair.estimate.size());
    EXPECT_EQ(total(found.reference_to_estimate), pair.reference.size());
  }
}

TEST(Distribution, OfEqualMapsIsAllInTheFirstBin) {
  const test::Clouds clouds{test::sheet_cloud(100, 1), test::sheet_cloud(100, 1)};
  const Distribution found = distribution_of(clouds.pair(), &NearestPairs::distance_m);
  EXPECT_EQ(found.estimate_to_reference.counts[0], 100u);
  EXPECT_GT(found.bin_width, 0.0);
}

TEST(Ranked, AllValuesOfAFew) {
  const RankedValues few = ranked({3.0, 1.0, 2.0, 1.0});
  EXPECT_EQ(few.n, 4u);
  EXPECT_EQ(few.values, (std::vector<double>{1.0, 1.0, 2.0, 3.0}));
  EXPECT_EQ(ranked({7.0}).values, std::vector<double>{7.0});
  EXPECT_EQ(ranked({0.5, -2.0, -0.25, 0.0, -1e6}).values, (std::vector<double>{-1e6, -2.0, -0.25, 0.0, 0.5}));
  EXPECT_TRUE(ranked({}).values.empty());
}

TEST(Ranked, EvenlySpacedRanksOfMany) {
  Array<double> values(3 * (kMostRanked - 1) + 1);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(values.size() - i);  // 1 to n
  const RankedValues many = ranked(values);
  EXPECT_EQ(many.n, values.size());
  ASSERT_EQ(many.values.size(), kMostRanked);
  for (std::size_t i = 0; i < kMostRanked; ++i) ASSERT_EQ(many.values[i], static_cast<double>(3 * i + 1));
}

}  // namespace distribution_test
}  // namespace cmap
