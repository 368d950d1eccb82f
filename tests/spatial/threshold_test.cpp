#include "cmap/spatial/threshold.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cmap/spatial/radius.hpp"
#include "spatial/clouds.hpp"

namespace cmap {
namespace threshold_test {

TEST(FloatStep, IsThatOfSingleNumbers) {
  // 24 bits: from a power of two to the next, 2^23 steps.
  EXPECT_EQ(float_step(1.0f), 0x1p-23);
  EXPECT_EQ(float_step(1.999f), 0x1p-23);
  EXPECT_EQ(float_step(-2.0f), 0x1p-22);
  EXPECT_EQ(float_step(500000.0f), 0x1p-5);
  EXPECT_EQ(float_step(0.0f), 0x1p-149);
}

TEST(IsWithin, UpToItsStepsAboveTheThreshold) {
  const double step = 0x1p-23;
  for (double steps : {0.0, 1.0, 2.0}) {
    const double last = 1.0 + steps * step;
    EXPECT_TRUE(is_within(last * last, 1.0, steps, 1.5f)) << steps;
    const double beyond = last + 0.01 * step;
    EXPECT_FALSE(is_within(beyond * beyond, 1.0, steps, 1.5f)) << steps;
  }
  EXPECT_TRUE(is_within(0.0, 1.0, 0.0, 1.5f));
}

Array<float> best_within(const PointCloud& data, const PointCloud& queries, double radius_m, double steps) {
  const Bvh index(sort_points(data));
  const PointBlocks sorted = sort_points(queries);
  const ColorSearch search{radius_m, 0.0f, 1e6f, steps};
  return most_similar_color(index, sort_colors(data, index.points), sorted, sort_colors(queries, sorted),
                            find_nearest(index, sorted), search);
}

/// Voxel centers 0.1 m apart, as they are typed: as floats some are a little farther apart than a tenth.
PointCloud row_at(double y_m, double x0_m) {
  PointCloud cloud;
  for (int i = 0; i < 40; ++i) {
    cloud.positions.push_back(Eigen::Vector3d(x0_m + i, y_m, 0.7).cast<float>());
  }
  cloud.colors = Array<Rgb8>(cloud.size(), Rgb8{9, 9, 9});
  return cloud;
}

TEST(ColorSearch, ARadiusMeansWhatWasTyped) {
  for (double x0_m : {0.0, 300.0, -4000.0}) {
    const PointCloud data = row_at(0.1, x0_m), queries = row_at(0.2, x0_m);
    const auto count_within = [&](double radius_m, double steps) {
      const Array<float> best = best_within(data, queries, radius_m, steps);
      return std::count_if(best.begin(), best.end(), [](float v) { return v != kNoneWithin; });
    };
    EXPECT_EQ(count_within(0.1, kThresholdSteps), 40);
    EXPECT_EQ(count_within(0.1, 0.0), 0) << "0.2f - 0.1f is above a tenth";
    EXPECT_EQ(count_within(0.099, kThresholdSteps), 0);
  }
}

}  // namespace threshold_test
}  // namespace cmap
