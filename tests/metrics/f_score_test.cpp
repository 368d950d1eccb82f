#include <algorithm>
#include <cmath>

#include "cmap/metrics/geometry.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace f_score_test {

TEST(FScore, HandComputed) {
  EXPECT_EQ(f_score(0.0, 0.0), 0.0);
  EXPECT_EQ(f_score(1.0, 0.0), 0.0);
  EXPECT_EQ(f_score(1.0, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(f_score(1.0, 2.0 / 3.0), 0.8);
  EXPECT_EQ(f_score(0.25, 0.75), 0.375);
  EXPECT_TRUE(std::isnan(f_score(NAN, NAN)) && std::isnan(f_score(0.0, NAN))) << "what is missing is not 0";
}

TEST(FScore, LiesBetweenBothAndRisesWithEach) {
  for (double p = 0.05; p < 1.0; p += 0.1) {
    for (double r = 0.05; r < 1.0; r += 0.1) {
      EXPECT_EQ(f_score(p, r), f_score(r, p));
      // A harmonic mean of equal numbers may round past them by one digit.
      EXPECT_GE(f_score(p, r), std::min(p, r) * (1.0 - 1e-15));
      EXPECT_LE(f_score(p, r), std::max(p, r) * (1.0 + 1e-15));
      EXPECT_GT(f_score(p + 0.01, r), f_score(p, r));
    }
  }
}

TEST(FScore, OfMapsByHand) {
  // Estimate to reference: 0.25, 3; reference to estimate: 0.25, 3, 5. Within 0.25: precision 1/2, recall 1/3.
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}, {7, 0, 0}, {7, 8, 0}}),
                            test::cloud_of({{0.25f, 0, 0}, {7, 3, 0}})};
  const Record found = test::measured(catalog::f_score, clouds, test::with_thresholds({0.5, 0.25, 0.1}));
  const Record level = test::at_threshold(found, 1);
  EXPECT_EQ(test::number(level, "precision"), 0.5);
  EXPECT_EQ(test::number(level, "recall"), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(*level.value, 0.4);
  EXPECT_EQ(*test::at_threshold(found, 2).value, 0.0);
}

TEST(FScore, IsSymmetric) {
  const test::Clouds clouds = test::two_sheets();
  const Record one = test::measured(catalog::f_score, clouds);
  const Record other = test::measured(catalog::f_score, test::Clouds{clouds.estimate, clouds.reference});
  for (std::size_t t = 0; t < 5; ++t) EXPECT_EQ(*test::at_threshold(one, t).value, *test::at_threshold(other, t).value);
}

}  // namespace f_score_test
}  // namespace cmap
