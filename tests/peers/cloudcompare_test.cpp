#include "cmap/peers/cloudcompare.hpp"

#include <cmath>

#include "peers/peers_testing.hpp"

namespace cmap {
namespace cloudcompare_test {

using test::Doubles;

TEST(CloudCompareDistance, HandComputed) {
  const CloudCompareDistance found = cloudcompare_distance(Doubles{1.0, 9.0});
  EXPECT_EQ(found.mean_m, 2.0);
  EXPECT_EQ(found.standard_deviation_m, 1.0);  // population: 1, not sqrt 2
  EXPECT_EQ(cloudcompare_distance(Doubles{0.25, 0.25, 0.25}).standard_deviation_m, 0.0);
}

TEST(CloudCompareDistance, StoresDistancesAsFloats) {
  EXPECT_EQ(cloudcompare_distance(Doubles{0.01}).mean_m, static_cast<double>(0.1f));
}

TEST(CloudCompareDistance, EqualsTheDefinition) {
  const Doubles sq_dist = test::peer_squares(5000);
  double mean = 0.0, variance = 0.0;
  for (double sq : sq_dist) mean += std::sqrt(sq) / 5000.0;
  for (double sq : sq_dist) variance += (std::sqrt(sq) - mean) * (std::sqrt(sq) - mean) / 5000.0;
  const CloudCompareDistance found = cloudcompare_distance(sq_dist);
  EXPECT_NEAR(found.mean_m, mean, 3e-8);  // half a float digit of distances below 1 m
  EXPECT_NEAR(found.standard_deviation_m, std::sqrt(variance), 1e-7);
}

}  // namespace cloudcompare_test
}  // namespace cmap
