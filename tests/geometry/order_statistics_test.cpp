#include "cmap/geometry/order_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "spatial/clouds.hpp"

namespace cmap {
namespace order_statistics_test {

double quantile(const std::vector<double>& values, double share) {
  return quantiles(values, std::array{share}).front();
}

/// Type 7 from sorted values, weighting both neighbors.
double sorted_quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double rank = static_cast<double>(values.size() - 1) * share;
  const auto low = static_cast<std::size_t>(rank);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  const double weight = rank - static_cast<double>(low);
  return values[low] * (1.0 - weight) + values[high] * weight;
}

/// Positive values over many magnitudes, and many that are equal.
std::vector<double> wide_values(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) {
    const double magnitude = std::pow(10.0, std::floor(40.0 * test::uniform(random)) - 20.0);
    values.push_back(i % 3 == 0 ? 0.125 : magnitude * test::uniform(random));
  }
  return values;
}

TEST(Quantiles, HandComputed) {
  const std::vector<double> values{4, 1, 3, 2};
  EXPECT_EQ(quantiles(values, std::array{0.0, 0.25, 0.5, 0.75, 1.0}), (std::vector<double>{1, 1.75, 2.5, 3.25, 4}));
  // 0.25 + 0.95 x 2.75, two roundings
  EXPECT_DOUBLE_EQ(quantile({3, 0.25}, 0.95), 2.8625);
  EXPECT_EQ(quantile({1, 2, 4}, 0.5), 2);
}

TEST(Quantiles, OneValueIsEveryQuantile) {
  for (double share : {0.0, 0.3, 0.5, 1.0}) EXPECT_EQ(quantile({7.5}, share), 7.5);
}

TEST(Quantiles, NoValuesHaveNone) {
  for (double q : quantiles({}, std::array{0.0, 0.5, 1.0})) EXPECT_TRUE(std::isnan(q));
  EXPECT_TRUE(quantiles(std::array{1.0}, {}).empty());
}

TEST(Quantiles, ZerosOfBothSignsAndExtremes) {
  EXPECT_EQ(quantile({0.0, -0.0, 0.0}, 0.5), 0.0);
  EXPECT_EQ(quantile({1.0, -0.0, 0.0}, 1.0), 1.0);
  EXPECT_EQ(quantile({-0.0, 1.0}, 0.5), 0.5);
  const double tiny = std::numeric_limits<double>::denorm_min();
  const double huge = std::numeric_limits<double>::max();
  EXPECT_EQ(quantiles(std::vector{huge, tiny, 0.0}, std::array{0.0, 0.5, 1.0}), (std::vector<double>{0.0, tiny, huge}));
}

TEST(Quantiles, EqualSortedValues) {
  const std::array shares{0.0, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 1.0};
  for (std::size_t n : {1, 2, 3, 10, 101, 5000, 70000}) {
    SCOPED_TRACE(n);
    const std::vector<double> values = wide_values(n, static_cast<unsigned>(n));
    const std::vector<double> found = quantiles(values, shares);
    for (std::size_t s = 0; s < shares.size(); ++s) {
      const double expected = sorted_quantile(values, shares[s]);
      // Another way to write the interpolation between two values, in a few roundings of the larger of them.
      const double larger = sorted_quantile(values, std::min(1.0, shares[s] + 1.0 / static_cast<double>(n)));
      EXPECT_NEAR(found[s], expected, 1e-15 * larger);
    }
  }
}

TEST(Quantiles, RiseWithTheShareAndStayWithinTheValues) {
  const std::vector<double> values = wide_values(1000, 11);
  std::vector<double> shares;
  for (int i = 0; i <= 1000; ++i) shares.push_back(i / 1000.0);
  const std::vector<double> found = quantiles(values, shares);
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
  EXPECT_EQ(found.front(), *std::min_element(values.begin(), values.end()));
  EXPECT_EQ(found.back(), *std::max_element(values.begin(), values.end()));
}

TEST(Quantiles, AreTheSameInAnyOrder) {
  std::vector<double> values = wide_values(2000, 12);
  const std::array shares{0.1, 0.5, 0.95};
  const std::vector<double> found = quantiles(values, shares);
  std::reverse(values.begin(), values.end());
  std::rotate(values.begin(), values.begin() + 777, values.end());
  EXPECT_EQ(quantiles(values, shares), found);
}

TEST(PrefixQuantiles, AreThoseOfTheLowestValues) {
  const std::vector<double> values = wide_values(3000, 13);
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint64_t n : {1ull, 2ull, 999ull, 3000ull}) {
    const std::vector<double> lowest(sorted.begin(), sorted.begin() + static_cast<long>(n));
    const std::array<PrefixQuantile, 2> wanted{{{n, 0.5}, {n, 0.9}}};
    EXPECT_EQ(prefix_quantiles(values, wanted), quantiles(lowest, std::array{0.5, 0.9})) << n;
  }
}

TEST(PrefixQuantiles, OfNoValueIsMissing) {
  const std::array<PrefixQuantile, 2> wanted{{{0, 0.5}, {2, 0.5}}};
  const std::vector<double> found = prefix_quantiles(std::array{1.0, 2.0}, wanted);
  EXPECT_TRUE(std::isnan(found[0]));
  EXPECT_EQ(found[1], 1.5);
}

TEST(PrefixQuantiles, MeasureComesBeforeTheInterpolation) {
  const std::array<PrefixQuantile, 1> median{{{2, 0.5}}};
  const auto root = [](double v) { return std::sqrt(v); };
  EXPECT_EQ(prefix_quantiles(std::array{1.0, 9.0}, median, root).front(), 2.0);  // not sqrt 5
}

}  // namespace order_statistics_test
}  // namespace cmap
