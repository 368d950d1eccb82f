#include <cmath>

#include "metrics/measured.hpp"

namespace cmap {
namespace color_fidelity_test {

TEST(ColorFidelity, HandComputed) {
  // One pair of points; colors 255, 25.5 (in float) and 0 apart.
  const auto fidelity = [](RgbF color) {
    test::Clouds clouds{test::cloud_of({{0, 0, 0}}), test::cloud_of({{0, 0, 0}})};
    clouds.reference.colors = Array<RgbF>{{0, 0, 0}};
    clouds.estimate.colors = Array<RgbF>{color};
    return *test::measured(catalog::color_fidelity, clouds).value;
  };
  EXPECT_EQ(fidelity({1, 0, 0}), 0.0);
  EXPECT_DOUBLE_EQ(fidelity({0.125f, 0, 0}), -20.0 * std::log10(0.125));
  EXPECT_DOUBLE_EQ(fidelity({1, 1, 1}), -10.0 * std::log10(3.0));
  EXPECT_EQ(fidelity({0, 0, 0}), INFINITY);
}

TEST(ColorFidelity, ExactColorsAreWarnedOf) {
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}}, {{1, 2, 3}}), test::cloud_of({{0, 0, 1}}, {{1, 2, 3}})};
  const MapPair pair = clouds.pair();
  const MetricOptions options;
  MetricInputs inputs(options, pair);
  std::vector<Warning> warnings;
  measure(catalog::color_fidelity, inputs, warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].id, "color_fidelity_infinite");
}

}  // namespace color_fidelity_test
}  // namespace cmap
