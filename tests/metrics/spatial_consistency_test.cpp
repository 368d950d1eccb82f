#include <cmath>

#include "cmap/metrics/wasserstein.hpp"
#include "metrics/map_pairs.hpp"

namespace cmap {
namespace {

using Voxels = std::vector<VoxelDistance>;

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
  const SpatialConsistency found = spatial_consistency(voxels, 5);
  EXPECT_DOUBLE_EQ(found.value, (1.0 / 3.0 + 0.6 + 1.0 / 3.0) / 3.0);
  EXPECT_EQ(found.n_voxels, 3U);
}

TEST(SpatialConsistency, TheNeighborhoodIsACubeWithItsBorder) {
  // Corners of the cube count; one voxel farther does not.
  const Voxels corner{{{-5, -5, -5}, 1.0}, {{0, 0, 0}, 9.0}, {{5, 5, 5}, 3.0}};
  const SpatialConsistency found = spatial_consistency(corner, 5);
  EXPECT_EQ(found.n_voxels, 3U);
  EXPECT_DOUBLE_EQ(found.value, 0.5 / 3.0);  // the center sees {1, 3}; the corners see it alone
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Voxels apart{{{0, 0, 0}, 1.0}, {{0, 0, 0}, 2.0}};
    apart[1].index[axis] = 6;
    EXPECT_EQ(spatial_consistency(apart, 5).n_voxels, 0U);
    EXPECT_EQ(spatial_consistency(apart, 6).n_voxels, 2U);
  }
}

TEST(SpatialConsistency, VoxelsWithoutOthersOrWithZeroOthersAreSkipped) {
  EXPECT_TRUE(std::isnan(spatial_consistency({}, 5).value));
  const Voxels alone{{{0, 0, 0}, 1.0}, {{100, 0, 0}, 2.0}};
  EXPECT_TRUE(std::isnan(spatial_consistency(alone, 5).value));
  EXPECT_EQ(spatial_consistency(alone, 5).n_voxels, 0U);
  // The nonzero voxel sees only zeros.
  const Voxels zeros{{{0, 0, 0}, 0.0}, {{1, 0, 0}, 0.0}, {{2, 0, 0}, 3.0}};
  const SpatialConsistency found = spatial_consistency(zeros, 5);
  EXPECT_EQ(found.n_voxels, 2U);
  EXPECT_DOUBLE_EQ(found.value, 1.0);  // {0, 3}: 1.5/1.5
}

TEST(SpatialConsistency, EqualDistancesVaryByExactlyZero) {
  Voxels voxels = random_voxels(3, 1);
  for (VoxelDistance& v : voxels) v.distance_m = 0.1;
  EXPECT_EQ(spatial_consistency(voxels, 2).value, 0.0);
}

TEST(SpatialConsistency, EqualsTheDefinition) {
  for (int radius : {1, 2, 5, 20}) {
    const Voxels voxels = random_voxels(6, 2);
    EXPECT_NEAR_RELATIVE(spatial_consistency(voxels, radius).value, by_definition(voxels, radius), test::kSummation);
  }
}

TEST(SpatialConsistency, DoesNotChangeWithScaleOrPlace) {
  const Voxels voxels = random_voxels(5, 3);
  const double expected = spatial_consistency(voxels, 3).value;
  Voxels changed = voxels;
  for (VoxelDistance& v : changed) {
    v.distance_m *= 8.0;
    for (std::int64_t& i : v.index) i += 4'000'000;
  }
  EXPECT_EQ(spatial_consistency(changed, 3).value, expected);
}

TEST(SpatialConsistency, SameBitsForAnyNumberOfThreads) {
  const Voxels voxels = random_voxels(8, 4);
  const double many = spatial_consistency(voxels, 3).value;
  const ThreadLimit limit(1);
  EXPECT_EQ(spatial_consistency(voxels, 3).value, many);
}

TEST(SpatialConsistency, OfMaps) {
  const auto scs = [](const test::Clouds& clouds, double voxel_m = 4.0) {
    return spatial_consistency(wasserstein_distances(gaussian_pairs(clouds.pair(), voxel_m, 20)), 5);
  };
  const test::Clouds clouds = test::two_sheets();
  const SpatialConsistency expected = scs(clouds);
  ASSERT_GT(expected.n_voxels, 10U);
  EXPECT_GT(expected.value, 0.0);
  // As for the average Wasserstein distance: 1e-10 m at a million meters, of 0.1 m.
  EXPECT_NEAR_RELATIVE(scs(test::moved(clouds, test::translation({1e6, -1e6, 4e5}))).value, expected.value, 1e-8);
  EXPECT_NEAR_RELATIVE(scs(test::permuted(clouds)).value, expected.value, test::kSummation);
  EXPECT_NEAR_RELATIVE(scs(test::moved(clouds, test::scaling(2.0)), 8.0).value, expected.value, test::kSummation);
  EXPECT_EQ(scs({clouds.reference, clouds.reference}).n_voxels, 0U);  // every distance is 0
}

}  // namespace
}  // namespace cmap
