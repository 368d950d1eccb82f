#include <cmath>

#include "cmap/core/execution.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace average_wasserstein_test {

using test::number;

/// Of these voxels in place of two maps'.
Record average_of(const std::vector<VoxelDistance>& voxels) {
  const MapPair pair = test::Clouds{test::cloud_of({{0, 0, 0}}), test::cloud_of({{0, 0, 0}})}.pair();
  MetricInputs inputs(MetricOptions{}, pair);
  inputs.wasserstein = VoxelWasserstein{{}, {voxels}, {}};
  std::vector<Warning> warnings;
  return measure(catalog::average_wasserstein, inputs, warnings);
}

Record average(const test::Clouds& clouds, double voxel_m = 4.0, std::uint64_t min_points = 20) {
  MetricOptions options;
  options.awd_voxel_m = voxel_m;
  options.awd_min_points = min_points;
  return test::measured(catalog::average_wasserstein, clouds, options);
}

void expect_same(const Record& found, const Record& expected, double tolerance, double scale = 1.0) {
  ASSERT_GT(number(expected, "n_voxels"), 10);
  EXPECT_EQ(number(found, "n_voxels"), number(expected, "n_voxels"));
  EXPECT_NEAR_RELATIVE(*found.value, scale * *expected.value, tolerance);
  EXPECT_NEAR_RELATIVE(number(found, "median"), scale * number(expected, "median"), tolerance);
}

TEST(AverageWasserstein, HandComputed) {
  const std::vector<VoxelDistance> voxels{{{0, 0, 0}, 4.0}, {{1, 0, 0}, 1.0}, {{2, 0, 0}, 1.0}};
  const Record found = average_of(voxels);
  EXPECT_EQ(*found.value, 2.0);
  EXPECT_EQ(number(found, "median"), 1.0);
  EXPECT_EQ(number(found, "n_voxels"), 3);
  const std::vector<Record>& cumulative = found.list("cumulative");
  ASSERT_EQ(cumulative.size(), 21U);
  EXPECT_EQ(number(cumulative[0], "value_m"), 1.0);
  EXPECT_EQ(number(cumulative[15], "share"), 0.75);
  EXPECT_DOUBLE_EQ(number(cumulative[15], "value_m"), 2.5);
  EXPECT_EQ(number(cumulative[20], "value_m"), 4.0);
}

TEST(AverageWasserstein, WithoutVoxelsIsMissing) {
  const Record none = average_of({});
  EXPECT_EQ(number(none, "n_voxels"), 0);
  EXPECT_TRUE(std::isnan(*none.value));
  EXPECT_TRUE(std::isnan(number(none, "median")));
  EXPECT_TRUE(none.list("cumulative").empty());
}

TEST(AverageWasserstein, OfAMapAndItselfIsZero) {
  for (const PointCloud& cloud : {test::two_sheets().reference, test::painted_triplicates(1000)}) {
    const Record same = average({cloud, cloud});
    EXPECT_GT(number(same, "n_voxels"), 10);
    EXPECT_EQ(*same.value, 0.0);
    EXPECT_EQ(number(same.list("cumulative").back(), "value_m"), 0.0);
  }
}

TEST(AverageWasserstein, OfAMapMovedInsideItsVoxelsIsTheMotion) {
  PointCloud reference = test::uniform_cloud(4000, 6, 2.0f);  // in the middle of one voxel
  for (Eigen::Vector3f& p : reference.positions) p += Eigen::Vector3f(1, 1, 1);
  PointCloud estimate = reference;
  for (Eigen::Vector3f& p : estimate.positions) p += Eigen::Vector3f(0.25f, -0.5f, 0.5f);
  // Positions are rounded to 2^-22 m when moved; the mean of 4000 to far less.
  EXPECT_NEAR(*average({reference, estimate}).value, 0.75, 1e-7);
}

TEST(AverageWasserstein, IsInvariantUnderPermutationAndShiftsByWholeVoxels) {
  const test::Clouds clouds = test::two_sheets();
  for (double voxel_m : {0.25, 4.0}) {
    const std::uint64_t min_points = voxel_m > 1.0 ? 20 : 2;
    const Record expected = average(clouds, voxel_m, min_points);
    expect_same(average(test::permuted(clouds), voxel_m, min_points), expected, 0.0);
    // Doubles at a million meters are rounded to 1e-10 m, of distances of 0.1 m.
    expect_same(average(test::moved(clouds, test::translation({1e6, -1e6, 4e5})), voxel_m, min_points), expected, 1e-8);
  }
}

TEST(AverageWasserstein, ScalesWithMapAndVoxel) {
  const test::Clouds clouds = test::two_sheets();
  expect_same(average(test::moved(clouds, test::scaling(2.0)), 8.0), average(clouds, 4.0), test::kSummation, 2.0);
}

TEST(AverageWasserstein, SameBitsForAnyNumberOfThreads) {
  const test::Clouds clouds = test::two_sheets(60000, 50000);
  const double many = *average(clouds, 0.5).value;
  const ExecutionScope limit({.threads = 1});
  EXPECT_EQ(*average(clouds, 0.5).value, many);
}

}  // namespace average_wasserstein_test
}  // namespace cmap
