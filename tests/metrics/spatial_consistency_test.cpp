#include <cmath>

#include "cmap/core/execution.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace spatial_consistency_test {

using Voxels = std::vector<VoxelDistance>;

/// Of these voxels in place of two maps'.
Record consistency_of(const Voxels& voxels, std::uint64_t radius) {
  const MapPair pair = test::Clouds{test::cloud_of({{0, 0, 0}}), test::cloud_of({{0, 0, 0}})}.pair();
  MetricOptions options;
  options.scs_radius_voxels = radius;
  MetricInputs inputs(options, pair);
  inputs.wasserstein = VoxelWasserstein{{}, {voxels}, {}};
  std::vector<Warning> warnings;
  return measure(catalog::spatial_consistency, inputs, warnings);
}

double n_voxels(const Record& record) { return test::number(record, "n_voxels"); }

double coefficient_of_variation(const std::vector<double>& values) {
  double mean = 0.0, variance = 0.0;
  for (double v : values) mean += v / static_cast<double>(values.size());
  for (double v : values) variance += (v - mean) * (v - mean) / static_cast<double>(values.size());
  return std::sqrt(variance) / mean;
}

/// The definition, every voxel against every other.
double by_definition(const Voxels& voxels, std::int64_t radius) {
  double sum = 0.0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    std::vector<double> others;
    for (std::size_t j = 0; j < voxels.size(); ++j) {
      bool near = i != j;
      for (std::size_t a = 0; a < 3; ++a) near = near && std::abs(voxels[i].index[a] - voxels[j].index[a]) <= radius;
      if (near) others.push_back(voxels[j].distance_m);
    }
    if (others.empty() || *std::max_element(others.begin(), others.end()) == 0.0) continue;
    sum += coefficient_of_variation(others);
    ++n;
  }
  return sum / static_cast<double>(n);
}

/// A third of the voxels of a cube around zero, in order.
Voxels random_voxels(int half, unsigned seed) {
  std::mt19937_64 random(seed);
  Voxels voxels;
  for (int x = -half; x <= half; ++x) {
    for (int y = -half; y <= half; ++y) {
      for (int z = -half; z <= half; ++z) {
        const double distance_m = test::uniform(random);
        if (test::uniform(random) < 0.33) voxels.push_back({{x, y, z}, distance_m});
      }
    }
  }
  return voxels;
}

TEST(SpatialConsistency, HandComputed) {
  const Voxels voxels{{{0, 0, 0}, 1.0}, {{1, 0, 0}, 2.0}, {{2, 0, 0}, 4.0}};
  // Others {2, 4}: 1/3; {1, 4}: 1.5/2.5; {1, 2}: 0.5/1.5.
  const Record found = consistency_of(voxels, 5);
  EXPECT_DOUBLE_EQ(*found.value, (1.0 / 3.0 + 0.6 + 1.0 / 3.0) / 3.0);
  EXPECT_EQ(n_voxels(found), 3);
}

TEST(SpatialConsistency, TheNeighborhoodIsACubeWithItsBorder) {
  // Corners of the cube count; one voxel farther does not.
  const Voxels corner{{{-5, -5, -5}, 1.0}, {{0, 0, 0}, 9.0}, {{5, 5, 5}, 3.0}};
  const Record found = consistency_of(corner, 5);
  EXPECT_EQ(n_voxels(found), 3);
  EXPECT_DOUBLE_EQ(*found.value, 0.5 / 3.0);  // the center sees {1, 3}; the corners see it alone
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Voxels apart{{{0, 0, 0}, 1.0}, {{0, 0, 0}, 2.0}};
    apart[1].index[axis] = 6;
    EXPECT_EQ(n_voxels(consistency_of(apart, 5)), 0);
    EXPECT_EQ(n_voxels(consistency_of(apart, 6)), 2);
  }
}

TEST(SpatialConsistency, VoxelsWithoutOthersOrWithZeroOthersAreSkipped) {
  EXPECT_TRUE(std::isnan(*consistency_of({}, 5).value));
  const Voxels alone{{{0, 0, 0}, 1.0}, {{100, 0, 0}, 2.0}};
  EXPECT_TRUE(std::isnan(*consistency_of(alone, 5).value));
  EXPECT_EQ(n_voxels(consistency_of(alone, 5)), 0);
  // The nonzero voxel sees only zeros.
  const Voxels zeros{{{0, 0, 0}, 0.0}, {{1, 0, 0}, 0.0}, {{2, 0, 0}, 3.0}};
  const Record found = consistency_of(zeros, 5);
  EXPECT_EQ(n_voxels(found), 2);
  EXPECT_DOUBLE_EQ(*found.value, 1.0);  // {0, 3}: 1.5/1.5
}

TEST(SpatialConsistency, EqualDistancesVaryByExactlyZero) {
  Voxels voxels = random_voxels(3, 1);
  for (VoxelDistance& v : voxels) v.distance_m = 0.1;
  EXPECT_EQ(*consistency_of(voxels, 2).value, 0.0);
}

TEST(SpatialConsistency, EqualsTheDefinition) {
  for (const std::uint64_t radius : {1u, 2u, 5u, 20u}) {
    const Voxels voxels = random_voxels(6, 2);
    EXPECT_NEAR_RELATIVE(*consistency_of(voxels, radius).value,
                         by_definition(voxels, static_cast<std::int64_t>(radius)), test::kSummation);
  }
}

TEST(SpatialConsistency, DoesNotChangeWithScaleOrPlace) {
  const Voxels voxels = random_voxels(5, 3);
  const double expected = *consistency_of(voxels, 3).value;
  Voxels changed = voxels;
  for (VoxelDistance& v : changed) {
    v.distance_m *= 8.0;
    for (std::int64_t& i : v.index) i += 4'000'000;
  }
  EXPECT_EQ(*consistency_of(changed, 3).value, expected);
}

TEST(SpatialConsistency, SameBitsForAnyNumberOfThreads) {
  const Voxels voxels = random_voxels(8, 4);
  const double many = *consistency_of(voxels, 3).value;
  const ExecutionScope limit({.threads = 1});
  EXPECT_EQ(*consistency_of(voxels, 3).value, many);
}

TEST(SpatialConsistency, OfMaps) {
  const auto scs = [](const test::Clouds& clouds, double voxel_m = 4.0) {
    MetricOptions options;
    options.awd_voxel_m = voxel_m;
    options.awd_min_points = 20;
    return test::measured(catalog::spatial_consistency, clouds, options);
  };
  const test::Clouds clouds = test::two_sheets();
  const Record expected = scs(clouds);
  ASSERT_GT(n_voxels(expected), 10);
  EXPECT_GT(*expected.value, 0.0);
  // As for the average Wasserstein distance: 1e-10 m at a million meters, of 0.1 m.
  EXPECT_NEAR_RELATIVE(*scs(test::moved(clouds, test::translation({1e6, -1e6, 4e5}))).value, *expected.value, 1e-8);
  EXPECT_EQ(*scs(test::permuted(clouds)).value, *expected.value);
  EXPECT_NEAR_RELATIVE(*scs(test::moved(clouds, test::scaling(2.0)), 8.0).value, *expected.value, test::kSummation);
  EXPECT_EQ(n_voxels(scs({clouds.reference, clouds.reference})), 0) << "every distance is 0";
}

}  // namespace spatial_consistency_test
}  // namespace cmap
