#include <algorithm>
#include <cmath>
#include <map>

#include "cmap/metrics/color_gaussians.hpp"
#include "cmap/metrics/wasserstein.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace grid_phases_test {

/// The points of one voxel, and their moments as they are written down.
struct Listed {
  std::vector<Eigen::Vector3d> reference, estimate;
};

Gaussian gaussian_of(const std::vector<Eigen::Vector3d>& points) {
  Gaussian g;
  g.n = points.size();
  for (const Eigen::Vector3d& p : points) g.mean += p / static_cast<double>(points.size());
  for (const Eigen::Vector3d& p : points) g.scatter += (p - g.mean) * (p - g.mean).transpose();
  return g;
}

/// By the definition: cells floor(m x / v), of which a phase's voxel floor((cell + k) / m).
std::map<VoxelIndex, double> distances_by_definition(const test::Clouds& clouds, double voxel_m, int m, int phase,
                                                     std::uint64_t min_points) {
  const int shift[]{phase / (m * m), phase / m % m, phase % m};
  std::map<VoxelIndex, Listed> voxels;
  const auto list = [&](const PointCloud& cloud, std::vector<Eigen::Vector3d> Listed::*side) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      VoxelIndex index;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double cell = std::floor(m * cloud.world(i)[static_cast<Eigen::Index>(axis)] / voxel_m);
        index[axis] = static_cast<std::int64_t>(std::floor((cell + shift[axis]) / m));
      }
      (voxels[index].*side).push_back(cloud.world(i));
    }
  };
  list(clouds.reference, &Listed::reference);
  list(clouds.estimate, &Listed::estimate);
  std::map<VoxelIndex, double> distances;
  for (const auto& [index, points] : voxels) {
    if (std::min(points.reference.size(), points.estimate.size()) < min_points) continue;
    distances[index] = wasserstein_distance(gaussian_of(points.reference), gaussian_of(points.estimate));
  }
  return distances;
}

TEST(GridPhases, EqualTheDefinition) {
  const test::Clouds clouds = test::two_sheets(20000, 15000);
  for (const int m : {1, 2, 3}) {
    for (const double voxel_m : {0.5, 1.3}) {
      const VoxelWasserstein found =
          voxel_wasserstein(clouds.pair(), {.voxel_m = voxel_m, .min_points = 5, .parts_per_axis = m});
      ASSERT_EQ(found.by_phase.size(), static_cast<std::size_t>(m * m * m));
      for (int phase = 0; phase < m * m * m; ++phase) {
        const auto expected = distances_by_definition(clouds, voxel_m, m, phase, 5);
        const std::vector<VoxelDistance>& voxels = found.by_phase[static_cast<std::size_t>(phase)];
        ASSERT_GT(expected.size(), 20U);
        ASSERT_EQ(voxels.size(), expected.size());
        for (const auto& [index, distance_m] : voxels) {
          // Offsets are rounded to 2^-30 m, and the listed sums to some 1e-15 of coordinates of 10 m.
          ASSERT_TRUE(expected.contains(index));
          EXPECT_NEAR(distance_m, expected.at(index), 1e-7);
        }
      }
    }
  }
}

TEST(GridPhases, APlaneAtABorderOfVoxelsIsWholeInHalfOfThem) {
  // Reference at z = 0.99, estimate at z = 1.01, voxels of 1 m: no voxel holds both unless the grid is shifted in z,
  // where all of them do, 2 cm apart. Phases 1, 3, 5, 7 are shifted in z.
  std::vector<Eigen::Vector3f> below, above;
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 40; ++y) {
      below.emplace_back(0.05f + 0.1f * static_cast<float>(x), 0.05f + 0.1f * static_cast<float>(y), 0.99f);
      above.emplace_back(0.05f + 0.1f * static_cast<float>(x), 0.05f + 0.1f * static_cast<float>(y), 1.01f);
    }
  }
  MetricOptions options;
  options.awd_voxel_m = 1.0;
  options.awd_min_points = 10;
  const Record found =
      test::measured(catalog::average_wasserstein, {test::cloud_of(below), test::cloud_of(above)}, options);
  EXPECT_TRUE(std::isnan(*found.value));
  EXPECT_EQ(test::number(found, "phases.n"), 4);
  EXPECT_NEAR(test::number(found, "phases.mean"), 0.02, 1e-7);  // floats of 1
  EXPECT_NEAR(test::number(found, "phases.std"), 0.0, 1e-7);
  const auto& values = std::get<std::vector<double>>(found.part("phases")->numbers.back().value);
  for (std::size_t phase = 0; phase < values.size(); ++phase) EXPECT_EQ(std::isnan(values[phase]), phase % 2 == 0);
}

TEST(GridPhases, TheFirstIsTheValueAndAllAreWhateverTheOrderOfPoints) {
  const test::Clouds clouds = test::two_sheets(20000, 15000);
  for (const Metric* metric : {&catalog::average_wasserstein, &catalog::spatial_consistency}) {
    for (const GridPhases phases : {GridPhases::kEight, GridPhases::kTwentySeven}) {
      MetricOptions options;
      options.awd_voxel_m = 1.0;
      options.awd_min_points = 5;
      options.grid_phases = phases;
      const Record found = test::measured(*metric, clouds, options);
      const auto& values = std::get<std::vector<double>>(found.part("phases")->numbers.back().value);
      EXPECT_EQ(values.front(), *found.value);
      const Record permuted = test::measured(*metric, test::permuted(clouds), options);
      EXPECT_EQ(std::get<std::vector<double>>(permuted.part("phases")->numbers.back().value), values);
    }
  }
}

TEST(GridPhases, ColorConsistencysFirstIsItsValue) {
  const test::Clouds clouds = test::two_sheets(20000, 15000);
  for (const Singletons singletons : {Singletons::kZero, Singletons::kExclude}) {
    MetricOptions options;
    options.ccs_phases = true;
    options.ccs_voxel_m = 0.5;
    options.ccs_singletons = singletons;
    const Record found = test::measured(catalog::color_consistency, clouds, options);
    const auto& values = std::get<std::vector<double>>(found.part("phases")->numbers.back().value);
    // Its traces come from a sum of squares, these from sums of products.
    EXPECT_NEAR_RELATIVE(values.front(), *found.value, 1e-12);
    EXPECT_EQ(values.size(), 8U);
  }
}

TEST(GridPhases, SmallestVoxelOfHalf) {
  // Ten points of both maps in a meter: 1 m voxels hold one each, 16 m voxels ten or more.
  std::vector<Eigen::Vector3f> places;
  for (int i = 0; i < 64; ++i) places.emplace_back(static_cast<float>(i) + 0.5f, 0.5f, 0.5f);
  const PointCloud cloud = test::cloud_of(places, std::vector<Rgb8>(64, {1, 2, 3}));
  const MapPair pair = test::Clouds{cloud, cloud}.pair();
  EXPECT_EQ(voxel_of_half(pair, 1.0, 10), 16.0);
  EXPECT_EQ(voxel_of_half(pair, 1.0, 1), 1.0);
  EXPECT_EQ(voxel_of_half(pair, 1.0, 65), std::nullopt);
}

}  // namespace grid_phases_test
}  // namespace cmap
