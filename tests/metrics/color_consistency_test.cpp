#include <cmath>
#include <map>

#include "cmap/core/error.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace color_consistency_test {

/// Both values, their counts, and the median.
struct Consistency {
  double zero, exclude, median;
  std::uint64_t n_occupied, n_enough, n_singletons, n_one_place;
};

MetricOptions options_of(double voxel_m, std::uint64_t min_points, Singletons singletons = Singletons::kZero) {
  MetricOptions options;
  options.ccs_voxel_m = voxel_m;
  options.ccs_min_points = min_points;
  options.ccs_singletons = singletons;
  return options;
}

Consistency consistency(const PointCloud& cloud, double voxel_m, std::uint64_t min_points = 2) {
  const Record zero = test::measured(catalog::color_consistency, cloud, options_of(voxel_m, min_points));
  const Record exclude =
      test::measured(catalog::color_consistency, cloud, options_of(voxel_m, min_points, Singletons::kExclude));
  const auto count = [](const Record& record, const char* name) {
    return static_cast<std::uint64_t>(test::number(record, name));
  };
  const ColorConsistency field = color_consistency(IndexedMap(cloud), voxel_m, min_points);
  return {*zero.value,
          *exclude.value,
          test::number(zero, "median"),
          count(zero, "n_voxels"),
          count(exclude, "n_voxels"),
          count(zero, "n_singletons"),
          static_cast<std::uint64_t>(field.n_one_place.value())};
}

PointCloud sheet() { return test::two_sheets().reference; }

constexpr Rgb8 kBlack{0, 0, 0};
constexpr Rgb8 kWhite{255, 255, 255};

/// Mean trace of the covariance by its definition: the mean first, then the squares about it.
double by_definition(const PointCloud& cloud, double voxel_m, std::size_t min_points) {
  std::map<std::array<double, 3>, std::vector<Eigen::Vector3d>> voxels;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d v = (cloud.world(i) / voxel_m).array().floor();
    voxels[{v.x(), v.y(), v.z()}].push_back(test::unit_color(cloud, i));
  }
  double sum = 0.0;
  std::size_t n_voxels = 0;
  for (const auto& [index, colors] : voxels) {
    if (colors.size() < min_points) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& c : colors) mean += c / static_cast<double>(colors.size());
    double trace = 0.0;
    for (const auto& c : colors) trace += (c - mean).squaredNorm() / static_cast<double>(colors.size() - 1);
    sum += trace;
    ++n_voxels;
  }
  return sum / static_cast<double>(n_voxels);
}

void expect_same(const Consistency& found, const Consistency& expected) {
  EXPECT_EQ(found.n_enough, expected.n_enough);
  EXPECT_EQ(found.n_occupied, expected.n_occupied);
  EXPECT_EQ(found.n_singletons, expected.n_singletons);
  EXPECT_NEAR_RELATIVE(found.zero, expected.zero, test::kSummation);
  EXPECT_NEAR_RELATIVE(found.exclude, expected.exclude, test::kSummation);
  EXPECT_NEAR_RELATIVE(found.median, expected.median, test::kSummation);
}

TEST(ColorConsistency, HalfBlackHalfWhite) {
  for (std::size_t n : {2, 4, 6, 100, 4096}) {
    PointCloud cloud = test::uniform_cloud(n, 1, 0.9f);
    Array<Rgb8> colors(n, kBlack);
    std::fill(colors.begin() + static_cast<long>(n / 2), colors.end(), kWhite);
    cloud.colors = colors;
    const Consistency found = consistency(cloud, 1.0);
    EXPECT_EQ(found.n_occupied, 1U);
    const auto count = static_cast<double>(n);
    EXPECT_DOUBLE_EQ(found.exclude, 3.0 * count / (4.0 * (count - 1.0)));
    EXPECT_EQ(found.median, found.exclude);
  }
}

TEST(ColorConsistency, HandComputedOverThreeVoxels) {
  // Traces 1.5, 0 and 0.02 (red 0 and 51: variance 0.04 / 2); a single point below.
  const PointCloud cloud =
      test::cloud_of({{0.1f, 0, 0}, {0.2f, 0, 0}, {1.1f, 0, 0}, {1.2f, 0, 0}, {2.1f, 0, 0}, {2.2f, 0, 0}, {9, 9, 9}},
                     {kBlack, kWhite, {7, 8, 9}, {7, 8, 9}, {0, 3, 3}, {51, 3, 3}, kWhite});
  const Consistency found = consistency(cloud, 1.0);
  EXPECT_EQ(found.n_occupied, 4U);
  EXPECT_EQ(found.n_enough, 3U);
  EXPECT_EQ(found.n_singletons, 1U);
  EXPECT_DOUBLE_EQ(found.zero, 1.52 / 4.0);
  EXPECT_DOUBLE_EQ(found.exclude, 1.52 / 3.0);
  EXPECT_DOUBLE_EQ(found.median, 0.02);
}

/// The example of the authors' tool: two voxels of trace 0.02; a lone point makes them two of three.
TEST(ColorConsistency, TheAuthorsExample) {
  const std::vector<Eigen::Vector3f> positions{{0.01f, 0, 0}, {0.02f, 0, 0}, {1.01f, 0, 0}, {1.02f, 0, 0}};
  const std::vector<Rgb8> colors{kBlack, {51, 0, 0}, {0, 102, 0}, {0, 153, 0}};
  const PointCloud two = test::cloud_of(positions, colors);
  EXPECT_DOUBLE_EQ(consistency(two, 0.1).zero, 0.02);
  EXPECT_EQ(consistency(two, 0.1).n_singletons, 0U);
  const PointCloud lone = test::appended(two, test::cloud_of({{5, 5, 5}}, {kWhite}));
  EXPECT_DOUBLE_EQ(consistency(lone, 0.1).zero, 0.02 * 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(consistency(lone, 0.1).exclude, 0.02);
}

TEST(ColorConsistency, OnePointAVoxelIsPerfectAndHasNoMedian) {
  const Consistency found = consistency(test::cloud_of({{0, 0, 0}, {5, 0, 0}}, {kBlack, kWhite}), 1.0);
  EXPECT_EQ(found.zero, 0.0);
  EXPECT_TRUE(std::isnan(found.exclude));
  EXPECT_TRUE(std::isnan(found.median));
  EXPECT_EQ(found.n_singletons, 2U);
}

TEST(ColorConsistency, CopiesOfAPointAreAtOnePlace) {
  // Three copies; two copies of other colors; two places; a single point.
  const PointCloud cloud = test::cloud_of(
      {{0.5f, 0, 0}, {0.5f, 0, 0}, {0.5f, 0, 0}, {3, 0, 0}, {3, 0, 0}, {6.25f, 0, 0}, {6.5f, 0, 0}, {9, 0, 0}},
      {kBlack, kBlack, kBlack, kBlack, kWhite, kBlack, kBlack, kBlack});
  const Consistency found = consistency(cloud, 1.0);
  EXPECT_EQ(found.n_occupied, 4U);
  EXPECT_EQ(found.n_singletons, 1U);
  EXPECT_EQ(found.n_one_place, 2U);
}

TEST(ColorConsistency, PointsWithoutColorOccupyNothing) {
  PointCloud cloud = test::cloud_of({{0.1f, 0, 0}, {0.2f, 0, 0}, {0.3f, 0, 0}, {5, 0, 0}});
  cloud.colors = Array<RgbF>{{0, 0, 0}, {1, 0, 0}, {NAN, NAN, NAN}, {NAN, NAN, NAN}};
  const Consistency found = consistency(cloud, 1.0);
  EXPECT_EQ(found.n_occupied, 1U);
  EXPECT_EQ(found.zero, 0.5);
  EXPECT_EQ(found.exclude, 0.5);
}

TEST(ColorConsistency, ItsVoxelsAreThoseOfTheMean) {
  const IndexedMap map(sheet());
  const std::vector<VoxelColors> voxels = voxel_colors(map, 0.5);
  for (const Singletons singletons : {Singletons::kZero, Singletons::kExclude}) {
    const Record found = test::measured(catalog::color_consistency, sheet(), options_of(0.5, 3, singletons));
    double sum = 0.0, n = 0.0;
    for (const VoxelColors& voxel : voxels) {
      if (!is_in_mean(voxel, singletons, 3)) continue;
      sum += voxel.trace;
      ++n;
    }
    EXPECT_EQ(n, test::number(found, "n_voxels"));
    EXPECT_NEAR_RELATIVE(sum / n, *found.value, test::kSummation);
  }
}

TEST(ColorConsistency, VoxelsAreAnchoredAtTheWorldsOriginAndHoldTheirLowerBorder) {
  // -0.1 and 0.1 are apart, 1.0 belongs to the upper voxel.
  const std::vector<Eigen::Vector3f> positions{{-0.1f, 0, 0}, {0.1f, 0, 0}, {1.0f, 0, 0}, {1.9f, 0, 0}};
  PointCloud cloud = test::cloud_of(positions, {kBlack, kWhite, kBlack, kWhite});
  EXPECT_EQ(consistency(cloud, 1.0).n_enough, 1U);
  EXPECT_EQ(consistency(cloud, 1.0).n_singletons, 2U);
  // The same points from another origin: the world counts, not the offsets.
  for (Eigen::Vector3f& p : cloud.positions) p.x() += 0.5f;
  cloud.origin.x() = -0.5;
  EXPECT_EQ(consistency(cloud, 1.0).n_singletons, 2U);
}

TEST(ColorConsistency, MinPointsLeavesThinVoxelsOut) {
  const PointCloud cloud = sheet();
  Consistency before = consistency(cloud, 0.5, 2);
  for (std::uint64_t min_points : {3, 4, 6}) {
    const Consistency after = consistency(cloud, 0.5, min_points);
    EXPECT_LT(after.n_enough, before.n_enough);
    EXPECT_EQ(after.n_occupied, before.n_occupied);
    EXPECT_EQ(after.zero, before.zero) << "which has no least number";
    EXPECT_NEAR_RELATIVE(after.exclude, by_definition(cloud, 0.5, min_points), test::kSummation);
    before = after;
  }
}

TEST(ColorConsistency, NoVoxelIsMissing) {
  const Consistency none = consistency(sheet(), 100.0, 5000);
  EXPECT_EQ(none.n_enough, 0U);
  EXPECT_TRUE(std::isnan(none.exclude));
  EXPECT_FALSE(std::isnan(none.zero));
}

TEST(ColorConsistency, EqualsTheDefinition) {
  for (double voxel_m : {0.2, 0.25, 0.7, 4.0, 300.0}) {
    SCOPED_TRACE(voxel_m);
    const Consistency found = consistency(sheet(), voxel_m);
    EXPECT_NEAR_RELATIVE(found.exclude, by_definition(sheet(), voxel_m, 2), test::kSummation);
    // The other mean differs by its number of voxels alone.
    const double share = static_cast<double>(found.n_enough) / static_cast<double>(found.n_occupied);
    EXPECT_NEAR_RELATIVE(found.zero, share * found.exclude, test::kSummation);
    EXPECT_EQ(found.n_occupied, found.n_enough + found.n_singletons);
  }
}

TEST(ColorConsistency, OneColorIsPerfectlyConsistent) {
  PointCloud cloud = test::sheet_cloud(2000, 1);
  cloud.colors = Array<Rgb8>(2000, Rgb8{255, 253, 251});
  EXPECT_EQ(consistency(cloud, 2.0).exclude, 0.0);
  cloud.colors = Array<RgbF>(2000, RgbF{0.1f, 0.7f, 0.3f});
  // Sums of squares below 1e5 a point are rounded; never below 0.
  EXPECT_GE(consistency(cloud, 2.0).exclude, 0.0);
  EXPECT_LT(consistency(cloud, 2.0).exclude, 1e-14);
}

TEST(ColorConsistency, DoesNotChangeWithAColorShift) {
  PointCloud cloud = test::sheet_cloud(2000, 1);
  Array<Rgb8> colors(2000);
  for (std::size_t i = 0; i < 2000; ++i)
    colors[i] = {static_cast<std::uint8_t>(i % 100), static_cast<std::uint8_t>(i % 41), 0};
  cloud.colors = colors;
  const Consistency expected = consistency(cloud, 1.0);
  for (Rgb8& c : colors) c = {static_cast<std::uint8_t>(c[0] + 100), static_cast<std::uint8_t>(c[1] + 100), 100};
  cloud.colors = colors;
  expect_same(consistency(cloud, 1.0), expected);
}

TEST(ColorConsistency, IsInvariantUnderPermutation) {
  expect_same(consistency(test::permuted(sheet(), 9), 0.5), consistency(sheet(), 0.5));
}

TEST(ColorConsistency, IsInvariantUnderShiftsByWholeVoxels) {
  for (double voxel_m : {0.25, 4.0}) {
    PointCloud cloud = sheet();
    const Consistency expected = consistency(cloud, voxel_m);
    cloud.origin = {1e6, -1e6, 1e6};
    expect_same(consistency(cloud, voxel_m), expected);
    expect_same(consistency(transformed(sheet(), test::translation({-1e6, 1e6, 4.0})), voxel_m), expected);
    cloud.origin = {0.3 * voxel_m, 0, 0};  // not whole: other voxels
    EXPECT_NE(consistency(cloud, voxel_m).exclude, expected.exclude);
  }
}

TEST(ColorConsistency, ScalesWithMapAndVoxel) {
  expect_same(consistency(transformed(sheet(), test::scaling(8.0)), 4.0), consistency(sheet(), 0.5));
}

TEST(ColorConsistency, RefusesWhatItCannotDo) {
  EXPECT_THROW(consistency(sheet(), 1e-9), UsageError);  // 2e10 voxels along an axis
  EXPECT_THROW(consistency(test::sheet_cloud(10, 1), 1.0), std::invalid_argument);
}

}  // namespace color_consistency_test
}  // namespace cmap
