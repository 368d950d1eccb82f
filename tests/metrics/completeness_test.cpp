#include "metrics/measured.hpp"

namespace cmap {
namespace completeness_test {

using test::at_threshold;
using test::measured;

const std::vector<double> kThresholds_m{0.1, 0.2, 0.5, 1.0};

Record completeness(const test::Clouds& clouds) {
  return measured(catalog::completeness, clouds, test::with_thresholds(kThresholds_m));
}

/// Of three reference points two are within half a meter of the estimate; precision is another number.
TEST(Completeness, HandComputed) {
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}, {1, 0, 0}, {9, 0, 0}}),
                            test::cloud_of({{0.25f, 0, 0}, {1, 0.5f, 0}, {20, 0, 0}, {30, 0, 0}})};
  const Record found = completeness(clouds);
  EXPECT_EQ(test::number(found, "n_points"), 3);
  EXPECT_EQ(*at_threshold(found, 2).value, 2.0 / 3.0);
  EXPECT_EQ(test::number(at_threshold(found, 2), "n"), 2);
  EXPECT_EQ(*at_threshold(found, 0).value, 0.0);
}

TEST(Completeness, AppendedEstimatePointsNeverLowerIt) {
  test::Clouds clouds = test::two_sheets();
  Record before = completeness(clouds);
  for (unsigned step = 0; step < 4; ++step) {
    PointCloud more = test::sheet_cloud(400, 20 + step, step == 0 ? 500.0f : 20.0f);  // far ones first
    test::paint(more, step);
    clouds.estimate = test::appended(clouds.estimate, more);
    const Record after = completeness(clouds);
    for (std::size_t t = 0; t < kThresholds_m.size(); ++t) {
      EXPECT_GE(*at_threshold(after, t).value, *at_threshold(before, t).value);
    }
    if (step > 0) {
      EXPECT_GT(*at_threshold(after, 1).value, *at_threshold(before, 1).value);
    }
    before = after;
  }
}

}  // namespace completeness_test
}  // namespace cmap
