#include <cmath>

#include "cmap/core/execution.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace color_wasserstein_test {

using test::number;

MetricOptions voxels_of(double voxel_m, std::uint64_t min_points) {
  MetricOptions options;
  options.cw_voxel_m = voxel_m;
  options.cw_min_points = min_points;
  return options;
}

/// In the colors of the first, each channel further by so many levels.
PointCloud shifted_colors(PointCloud cloud, int levels) {
  for (Rgb8& color : std::get<Array<Rgb8>>(cloud.colors)) {
    for (std::uint8_t& channel : color) channel = static_cast<std::uint8_t>(channel / 2 + levels);
  }
  return cloud;
}

TEST(ColorWasserstein, HandComputed) {
  // One voxel. The reference has two black and two white points, the estimate four of one gray g: means differ by
  // (1/2 - g) sqrt 3; the reference's covariance has the one variance 3 x 1/3 along gray, the estimate's is 0, and
  // their root product is 0: W^2 = 3 (1/2 - g)^2 + 3 x 1/3.
  const std::vector<Eigen::Vector3f> places{{0.1f, 0.1f, 0.1f}, {0.2f, 0.1f, 0.1f}, {0.3f, 0.1f, 0.1f}, {0.4f, 0, 0}};
  const test::Clouds clouds{test::cloud_of(places, {{0, 0, 0}, {255, 255, 255}, {0, 0, 0}, {255, 255, 255}}),
                            test::cloud_of(places, std::vector<Rgb8>(4, {51, 51, 51}))};
  const Record found = test::measured(catalog::color_wasserstein, clouds, voxels_of(1.0, 4));
  EXPECT_NEAR(*found.value, std::sqrt(3 * 0.3 * 0.3 + 1.0), 1e-14);  // some roundings of 1
  EXPECT_EQ(number(found, "n_voxels"), 1);
  EXPECT_EQ(number(found, "share_estimate"), 1.0);
  EXPECT_EQ(number(found, "share_reference"), 1.0);
  const Record none = test::measured(catalog::color_wasserstein, clouds, voxels_of(1.0, 5));
  EXPECT_TRUE(std::isnan(*none.value));
  EXPECT_EQ(number(none, "share_estimate"), 0.0);
}

TEST(ColorWasserstein, OfAConstantShiftIsTheShiftInEveryPhase) {
  const test::Clouds sheets = test::two_sheets(20000, 1);
  const test::Clouds clouds{shifted_colors(sheets.reference, 0), shifted_colors(sheets.reference, 51)};
  const Record found = test::measured(catalog::color_wasserstein, clouds, voxels_of(2.0, 10));
  EXPECT_GT(number(found, "n_voxels"), 20);
  EXPECT_NEAR(*found.value, 0.2 * std::sqrt(3.0), 1e-12);  // of traces below 1
  for (const char* name : {"phases.mean", "phases.min", "phases.max"}) {
    EXPECT_NEAR(number(found, name), 0.2 * std::sqrt(3.0), 1e-12);
  }
  EXPECT_EQ(number(found, "phases.n"), 8);
}

/// The same colors as floats, whose sums have words of another size and steps of another kind.
PointCloud with_float_colors(PointCloud cloud) {
  Array<RgbF> floats;
  for (const Rgb8& color : std::get<Array<Rgb8>>(cloud.colors)) {
    floats.push_back({static_cast<float>(color[0]) / 255.0f, static_cast<float>(color[1]) / 255.0f,
                      static_cast<float>(color[2]) / 255.0f});
  }
  cloud.colors = std::move(floats);
  return cloud;
}

TEST(ColorWasserstein, IsThatOfTheSameColorsAsFloats) {
  const PointCloud sheet = test::two_sheets(20000, 1).reference;
  const test::Clouds sheets{sheet, shifted_colors(sheet, 30)};
  const test::Clouds floats{with_float_colors(sheets.reference), with_float_colors(sheets.estimate)};
  const Record found = test::measured(catalog::color_wasserstein, sheets, voxels_of(2.0, 10));
  const Record expected = test::measured(catalog::color_wasserstein, floats, voxels_of(2.0, 10));
  EXPECT_NEAR(*found.value, *expected.value, 1e-6);  // what float's rounding of n / 255 moves a color
  EXPECT_NEAR(number(found, "phases.std"), number(expected, "phases.std"), 1e-6);
}

TEST(ColorWasserstein, OfMorePointsAVoxelThanNarrowWordsSum) {
  // Beyond 66,051 points of white the squares alone would wrap; what wraps may look like anything, NaN included.
  for (const std::size_t n : {65'536u, 65'537u, 70'000u, 140'000u, 1'000'000u}) {
    const std::vector<Eigen::Vector3f> places(n, {0.1f, 0.1f, 0.1f});
    std::vector<Rgb8> colors(n, {255, 255, 255});
    for (std::size_t i = 0; i < n; i += 2) colors[i] = {155, 255, 205};
    const test::Clouds clouds{test::cloud_of(places, colors),
                              test::cloud_of(places, std::vector<Rgb8>(n, {255, 255, 255}))};
    // Means differ by (50, 0, 25), and half and half of d apart has the variance d^2 / 4 n / (n - 1).
    const double spread =
        1.0 / 4.0 * (100.0 * 100.0 + 50.0 * 50.0) * static_cast<double>(n) / static_cast<double>(n - 1);
    const Record found = test::measured(catalog::color_wasserstein, clouds, voxels_of(1.0, 10));
    const double share = static_cast<double>((n + 1) / 2) / static_cast<double>(n);
    const double variance = 4.0 * share * (1.0 - share) * spread;
    const double shift = share * share * (100.0 * 100.0 + 50.0 * 50.0);
    EXPECT_NEAR(*found.value, std::sqrt(shift + variance) / 255.0, 1e-12) << n;
  }
}

TEST(ColorWasserstein, OfAMapAndItselfIsZero) {
  const PointCloud cloud = test::two_sheets().reference;
  EXPECT_EQ(*test::measured(catalog::color_wasserstein, {cloud, cloud}, voxels_of(4.0, 10)).value, 0.0);
}

TEST(ColorWasserstein, LeavesPointsWithoutColorOut) {
  test::Clouds clouds = test::two_sheets();
  const Record expected = test::measured(catalog::color_wasserstein, clouds, voxels_of(4.0, 10));
  const auto in_float = [](PointCloud& cloud) {
    Array<RgbF> colors;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3f c = test::unit_color(cloud, i).cast<float>();
      colors.push_back({c.x(), c.y(), c.z()});
    }
    for (std::size_t i = 0; i < 500; ++i) {
      cloud.positions.push_back(cloud.positions[i]);
      colors.push_back({NAN, NAN, NAN});
    }
    cloud.colors = colors;
  };
  in_float(clouds.reference);
  in_float(clouds.estimate);
  const Record found = test::measured(catalog::color_wasserstein, clouds, voxels_of(4.0, 10));
  EXPECT_NEAR(*found.value, *expected.value, 1e-6);  // single precision
  EXPECT_EQ(number(found, "n_voxels"), number(expected, "n_voxels"));
  EXPECT_EQ(number(found, "n_without_color_estimate"), 500);
}

TEST(ColorWasserstein, IsInvariantUnderPermutationAndShiftsByWholeVoxels) {
  const test::Clouds clouds = test::two_sheets();
  const Record expected = test::measured(catalog::color_wasserstein, clouds, voxels_of(2.0, 10));
  for (const test::Clouds& other : {test::permuted(clouds), test::moved(clouds, test::translation({1e6, -1e6, 4e5}))}) {
    const Record found = test::measured(catalog::color_wasserstein, other, voxels_of(2.0, 10));
    EXPECT_EQ(*found.value, *expected.value);
    EXPECT_EQ(number(found, "phases.std"), number(expected, "phases.std"));
  }
}

TEST(ColorWasserstein, ShuffledColorsAreAtChance) {
  test::Clouds clouds = test::two_sheets(40000, 40000);
  clouds.estimate = clouds.reference;
  auto& colors = std::get<Array<Rgb8>>(clouds.estimate.colors);
  std::mt19937_64 random(3);
  // Colors by place, so that a voxel's own are unlike the others'.
  for (PointCloud* cloud : {&clouds.reference, &clouds.estimate}) {
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      const auto level = static_cast<std::uint8_t>(std::clamp(cloud->positions[i].x() * 10.0f, 0.0f, 255.0f));
      std::get<Array<Rgb8>>(cloud->colors)[i] = {level, level, level};
    }
  }
  for (std::size_t i = colors.size(); i > 1; --i) std::swap(colors[i - 1], colors[random() % i]);
  const Record found = test::with_levels(catalog::color_wasserstein, clouds, voxels_of(2.0, 10));
  ASSERT_GT(number(found, "n_voxels"), 50);
  // Five standard errors of the chance, and of the shuffle, which is one more draw.
  EXPECT_NEAR(*found.value, number(found, "chance.value"), 5.0 * number(found, "chance.se"));
  EXPECT_NEAR(number(found, "skill.value"), 0.0, 0.05);
}

TEST(ColorWasserstein, OfTheReferencesOwnSurfaceHasSkillOne) {
  // Two samplings of one colored surface, each as dense as a half of the reference.
  const auto painted = [](std::size_t n, unsigned seed) {
    PointCloud cloud = test::sheet_cloud(n, seed);
    test::paint(cloud, seed + 1);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const float x = cloud.positions[i].x();
      Rgb8& color = std::get<Array<Rgb8>>(cloud.colors)[i];
      for (std::uint8_t& c : color) c = static_cast<std::uint8_t>(c / 8 + static_cast<int>(100 + 90 * std::sin(x)));
    }
    return cloud;
  };
  const Record found =
      test::with_levels(catalog::color_wasserstein, {painted(60000, 1), painted(30000, 5)}, voxels_of(2.0, 10));
  // Value against a full reference, not a half: its distance is below the floor's, by a factor near sqrt(3/4).
  EXPECT_GT(number(found, "skill.value"), 0.95);
  EXPECT_LT(number(found, "skill.value"), 1.1);
}

TEST(ColorWasserstein, SameBitsForAnyNumberOfThreads) {
  const test::Clouds clouds = test::two_sheets(60000, 50000);
  const Record many = test::with_levels(catalog::color_wasserstein, clouds, voxels_of(0.5, 4));
  const ExecutionScope limit({.threads = 1});
  const Record one = test::with_levels(catalog::color_wasserstein, clouds, voxels_of(0.5, 4));
  for (const char* name : {"value", "phases.mean", "phases.std", "floor.value", "chance.value"}) {
    EXPECT_EQ(one.number(name), many.number(name)) << name;
  }
}

}  // namespace color_wasserstein_test
}  // namespace cmap
