#include <cmath>

#include "cmap/geometry/color.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace delta_e_test {

using test::number;

Record delta_e(const test::Clouds& clouds, double radius_m) {
  MetricOptions options;
  options.lcr_radius_m = radius_m;
  return test::measured(catalog::delta_e, clouds, options);
}

TEST(DeltaE, HandComputed) {
  const test::Clouds clouds{
      test::cloud_of({{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}, {{255, 255, 255}, {90, 0, 0}, {0, 0, 0}}),
      test::cloud_of({{0, 0, 0}, {4, 0, 0.5f}, {8, 0, 0.6f}}, {{0, 0, 0}, {90, 0, 0}, {255, 0, 0}})};
  const Record found = delta_e(clouds, 0.5);
  // Black and white are L* 0 and 100 apart; the third pair is too far. S_L of that pair is 1.
  EXPECT_EQ(number(found, "estimate_to_reference.n"), 2);
  EXPECT_NEAR(*found.value, 50.0, 1e-9);
  EXPECT_NEAR(number(found, "estimate_to_reference.mean"), 50.0, 1e-9);
  EXPECT_NEAR(number(found, "estimate_to_reference.median"), 50.0, 1e-9);
  EXPECT_NEAR(number(found, "estimate_to_reference.p95"), 95.0, 1e-9);
  EXPECT_EQ(number(delta_e(clouds, 0.6000001), "estimate_to_reference.n"), 3);
}

TEST(DeltaE, EqualsTheDefinitionInBothDirections) {
  const test::Clouds clouds = test::two_sheets();
  const auto nearest = test::nearest_by_definition(clouds.reference, clouds.estimate);
  double sum = 0.0;
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i].distance_m > 0.3) continue;
    sum += delta_e_2000(srgb_to_lab(test::unit_color(clouds.reference, i)),
                        srgb_to_lab(test::unit_color(clouds.estimate, nearest[i].index)));
    ++n;
  }
  const Record found = delta_e(clouds, 0.3);
  EXPECT_EQ(number(found, "reference_to_estimate.n"), static_cast<double>(n));
  EXPECT_NEAR_RELATIVE(number(found, "reference_to_estimate.mean"), sum / static_cast<double>(n), test::kSummation);
  EXPECT_LT(number(found, "reference_to_estimate.median"), number(found, "reference_to_estimate.p95"));
}

TEST(DeltaE, WithoutPairsIsMissing) {
  const test::Clouds apart{test::cloud_of({{0, 0, 0}}, {{0, 0, 0}}), test::cloud_of({{1, 0, 0}}, {{51, 0, 0}})};
  const Record none = delta_e(apart, 0.5);
  EXPECT_TRUE(std::isnan(*none.value));
  EXPECT_EQ(number(none, "estimate_to_reference.n"), 0);
  EXPECT_TRUE(std::isnan(number(none, "estimate_to_reference.mean")));
  EXPECT_TRUE(std::isnan(number(none, "estimate_to_reference.median")));
}

TEST(DeltaE, OfAMapAndItselfIsZero) {
  const PointCloud cloud = test::painted_triplicates(200);
  const Record found = delta_e({cloud, cloud}, 1e-6);
  EXPECT_EQ(number(found, "estimate_to_reference.n"), 600);
  EXPECT_EQ(number(found, "estimate_to_reference.p95"), 0.0);
  EXPECT_EQ(*found.value, 0.0);
}

}  // namespace delta_e_test
}  // namespace cmap
