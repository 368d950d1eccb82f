#include "cmap/core/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace cmap {
namespace exact_sum_test {

__extension__ using Wide = __int128;

/// In units of 2^-72, each term rounded by the library's nearbyint: exact for sums below 2^54.
Wide by_definition(const std::vector<double>& terms) {
  Wide sum = 0;
  for (const double term : terms) sum += static_cast<Wide>(std::nearbyint(std::ldexp(term, 72)));
  return sum;
}

ExactSum sum_of(const std::vector<double>& terms) {
  ExactSum sum;
  for (const double term : terms) sum.add(term);
  return sum;
}

/// Of both signs, over 24 decades.
std::vector<double> scattered(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::lognormal_distribution<double> size(0.0, 9.0);
  std::vector<double> terms(n);
  for (double& term : terms) {
    const double v = std::min(size(random), 1e8);
    term = (random() & 1) != 0 ? v : -v;
  }
  return terms;
}

void expect_is(const ExactSum& found, Wide units) {
  ExactSum::Words words{static_cast<std::uint64_t>(units), static_cast<std::uint64_t>(units >> 64), 0, 0, 0, 0};
  for (std::size_t i = 2; i < words.size(); ++i) words[i] = units < 0 ? ~std::uint64_t{0} : 0;
  EXPECT_EQ(found.words(), words);
  EXPECT_EQ(found.value(), std::ldexp(static_cast<double>(units), -72)) << "conversion of an integer rounds to even";
}

TEST(ExactSum, OfNothingIsZero) {
  EXPECT_EQ(ExactSum().value(), 0.0);
  EXPECT_FALSE(std::signbit(sum_of({-0.0}).value()));
}

TEST(ExactSum, ByHand) {
  EXPECT_EQ(sum_of({0.1, 0.2, -0.3}).value(), 0x1p-55) << "what the three decimals are as doubles";
  EXPECT_EQ(sum_of({1e16, 1.0, -1e16}).value(), 1.0) << "which a plain sum loses";
  EXPECT_EQ(sum_of({0x1p200, 0x1p-72, -0x1p200}).value(), 0x1p-72);
  EXPECT_EQ(sum_of({0x1p-73}).value(), 0.0) << "ties go to the even multiple";
  EXPECT_EQ(sum_of({0x1.8p-72}).value(), 0x1p-71);
  EXPECT_EQ(sum_of({-0x1.8p-72}).value(), -0x1p-71);
  EXPECT_EQ(sum_of({0x1p53, 1.0}).value(), 0x1p53) << "and so does the double at the end";
  EXPECT_EQ(sum_of({0x1p53, 1.0, 0x1p-72}).value(), 0x1p53 + 2.0);
}

TEST(ExactSum, EqualsTheDefinition) {
  for (const std::size_t n : {1u, 7u, 1000u, 65'535u, 65'536u, 65'537u, 300'000u}) {
    const std::vector<double> terms = scattered(n, static_cast<unsigned>(n));
    expect_is(sum_of(terms), by_definition(terms));
  }
}

TEST(ExactSum, ASpanIsItsTerms) {
  const std::vector<double> terms = scattered(200'003, 3);
  for (const std::size_t before : {0u, 1u, 65'530u}) {
    ExactSum sum = sum_of({terms.begin(), terms.begin() + static_cast<long>(before)});
    sum.add(std::span(terms).subspan(before));
    EXPECT_EQ(sum, sum_of(terms)) << before;
  }
}

TEST(ExactSum, NeitherOrderNorGroupingChangesABit) {
  std::vector<double> terms = scattered(100'000, 4);
  const ExactSum whole = sum_of(terms);
  std::mt19937_64 random(5);
  for (int turn = 0; turn < 20; ++turn) {
    std::ranges::shuffle(terms, random);
    ExactSum merged;
    for (std::size_t begin = 0; begin < terms.size();) {
      const std::size_t n = std::min<std::size_t>(1 + random() % 9000, terms.size() - begin);
      ExactSum part;
      part.add(std::span(terms).subspan(begin, n));
      merged += part;
      begin += n;
    }
    EXPECT_EQ(merged, whole);
    EXPECT_EQ(merged.value(), whole.value());
  }
}

/// Just below the windows' limit, so that 2^16 of them fill the highest one.
TEST(ExactSum, ManyLargeTerms) {
  const double most = std::nextafter(0x1p29, 0.0);
  for (const double term : {most, -most}) {
    const std::vector<double> terms(200'000, term);
    expect_is(sum_of(terms), by_definition(terms));
    ExactSum sum;
    sum.add(terms);
    EXPECT_EQ(sum, sum_of(terms));
  }
}

/// Terms beyond the windows; the sum of multiples of 2^200 is a plain product.
TEST(ExactSum, TermsOfAnySizeUpToTheLimit) {
  const std::vector<double> huge(1000, 0x1.8p200);
  EXPECT_EQ(sum_of(huge).value(), 0x1.8p200 * 1000);
  ExactSum sum;
  sum.add(huge);
  EXPECT_EQ(sum, sum_of(huge));
  const double largest = 3.0 * std::pow(static_cast<double>(std::numeric_limits<float>::max()), 2.0);
  EXPECT_EQ(sum_of({largest, 0.25, -largest}).value(), 0.25) << "a squared distance of floats";
}

TEST(ExactSum, IsStoredAsItsWords) {
  for (const double extra : {0.0, 1e20, -1e20}) {
    std::vector<double> terms = scattered(1000, 6);
    terms.push_back(extra);
    const ExactSum sum = sum_of(terms);
    const ExactSum again = ExactSum::from_words(sum.words());
    EXPECT_EQ(again, sum);
    EXPECT_EQ(again.value(), sum.value());
  }
}

TEST(ExactSum, WhatIsNoNumberIsRefused) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double term : {std::nan(""), kInfinity, -kInfinity, 0x1p262}) {
    EXPECT_THROW(sum_of({term}), std::invalid_argument);
    ExactSum sum;
    const std::vector<double> terms{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, term, 9.0};
    EXPECT_THROW(sum.add(terms), std::invalid_argument);
  }
}

}  // namespace exact_sum_test
}  // namespace cmap
