#include "voxel_moments.hpp"

#include <cmath>

#include "grid_places.hpp"
#include "metrics/map_pairs.hpp"

namespace cmap {
namespace voxel_moments_test {

constexpr std::uint32_t kFarthest = 0xffffffff;

VoxelMoments moments_of(const std::vector<OffsetSteps>& points) {
  VoxelMoments moments;
  for (const OffsetSteps& point : points) moments.add(point);
  return moments;
}

std::vector<OffsetSteps> random_points(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<OffsetSteps> points(n);
  for (OffsetSteps& point : points) {
    for (std::uint32_t& steps : point) steps = static_cast<std::uint32_t>(random() >> 32);
  }
  return points;
}

void expect_same_bits(const Gaussian& found, const Gaussian& expected) {
  EXPECT_EQ(found.n, expected.n);
  EXPECT_EQ(found.mean, expected.mean);
  EXPECT_EQ(found.scatter, expected.scatter);
}

TEST(VoxelMoments, HandComputed) {
  // Mean (2, 1, 4); from it (-1, 0, -4), (0, 1, 2), (1, -1, 2).
  const Gaussian found = moments_of({{1, 1, 0}, {2, 2, 6}, {3, 0, 6}}).gaussian(0.5);
  EXPECT_EQ(found.n, 3U);
  EXPECT_EQ(found.mean, Eigen::Vector3d(1, 0.5, 2));
  Eigen::Matrix3d scatter;
  scatter << 2, -1, 6, -1, 2, 0, 6, 0, 24;
  EXPECT_EQ(found.scatter, 0.25 * scatter);
}

TEST(VoxelMoments, OfTheFarthestPointsKeepTheLastStep) {
  std::vector<OffsetSteps> points(1 << 20, {kFarthest, kFarthest, 0});
  points.back() = {kFarthest - 1, kFarthest, 0};
  const Gaussian found = moments_of(points).gaussian(1.0);
  // One of n points lies one step lower: (n - 1) / n.
  EXPECT_EQ(found.scatter(0, 0), 1.0 - 0x1p-20);
  EXPECT_EQ(found.scatter(0, 1), 0.0);
  EXPECT_EQ(found.scatter(1, 1), 0.0);
  EXPECT_EQ(found.mean.y(), kFarthest);
}

/// n scatter is the sum over all pairs of points of the products of their differences.
TEST(VoxelMoments, EqualTheSumOverPairsOfPoints) {
  __extension__ using Wide = __int128;
  const std::size_t n = 200;
  const std::vector<OffsetSteps> points = random_points(n, 1);
  const Gaussian found = moments_of(points).gaussian(0x1p-30);
  for (std::size_t a = 0; a < 3; ++a) {
    Wide sum = 0;
    for (const OffsetSteps& point : points) sum += point[a];
    EXPECT_EQ(found.mean[static_cast<Eigen::Index>(a)], static_cast<double>(sum) / n * 0x1p-30);
    for (std::size_t b = 0; b < 3; ++b) {
      Wide products = 0;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          products += (Wide{points[i][a]} - points[j][a]) * (Wide{points[i][b]} - points[j][b]);
        }
      }
      EXPECT_EQ(found.scatter(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)),
                static_cast<double>(products) / n * 0x1p-60);
    }
  }
}

TEST(VoxelMoments, AboutAFarCornerAreThoseAboutANearOne) {
  // 2^31 voxels of 2^32 steps away: sums and products wrap.
  const std::vector<OffsetSteps> points = random_points(1000, 5);
  const Corner away{std::int64_t{1} << 62, -(std::int64_t{1} << 61) - 12345, 7};
  const Gaussian near = moments_of(points).gaussian(0x1p-30);
  VoxelMoments far = moments_of(points);
  far.move(away);
  expect_same_bits(far.gaussian(0x1p-30, away), near);
  // In two parts, of which each was about its own corner.
  VoxelMoments parts = moments_of({points.begin(), points.begin() + 300});
  parts.move(away);
  VoxelMoments rest = moments_of({points.begin() + 300, points.end()});
  rest.move(away);
  expect_same_bits((parts += rest).gaussian(0x1p-30, away), near);
}

TEST(VoxelMoments, MovedPointsAreThoseOfTheirPlaces) {
  // (1, 0, 0) and (2, 5, 0), the second by (0, 0, 3): mean (1.5, 2.5, 1.5), half of the difference (0.5, 2.5, 1.5).
  VoxelMoments moments = moments_of({{1, 0, 0}}), moved = moments_of({{2, 5, 0}});
  moved.move({0, 0, 3});
  const Gaussian found = (moments += moved).gaussian(1.0);
  EXPECT_EQ(found.mean, Eigen::Vector3d(1.5, 2.5, 1.5));
  const Eigen::Vector3d half(0.5, 2.5, 1.5);
  EXPECT_EQ(found.scatter, 2.0 * half * half.transpose());
}

TEST(VoxelMoments, NeitherOrderNorPartsChangeABit) {
  std::vector<OffsetSteps> points = random_points(30'000, 2);
  const VoxelMoments whole = moments_of(points);
  std::mt19937_64 random(3);
  for (const std::size_t n_parts : {1u, 8u, 1000u}) {
    std::ranges::shuffle(points, random);
    std::vector<VoxelMoments> parts(n_parts);
    for (const OffsetSteps& point : points) parts[random() % n_parts].add(point);
    VoxelMoments merged;
    for (const VoxelMoments& part : parts) merged += part;
    EXPECT_EQ(merged, whole) << n_parts;
    expect_same_bits(merged.gaussian(0x1p-30), whole.gaussian(0x1p-30));
  }
}

const Box3d kBox{{-50, -50, -50}, {50, 50, 50}};

/// Of one point.
OffsetSteps offset_of(const Eigen::Vector3d& world, const VoxelFrame& frame, const VoxelKey& voxel) {
  PointBlocks points;
  points.origin = world;
  GridPlaces places{};
  places.x[0] = voxel.x;
  places.y[0] = voxel.y;
  places.z[0] = voxel.z;
  OffsetLanes offsets;
  const double steps_per_m = 1.0 / VoxelSteps(frame.size_m()).step_m();
  metric_kernels().offsets(part_grid(points, frame, 1, 32), steps_per_m, PointBlock{}, places, offsets);
  return {offsets.x[0], offsets.y[0], offsets.z[0]};
}

OffsetSteps steps_in_first_voxel(double x_m, double voxel_m) {
  const VoxelFrame frame(kBox, voxel_m);
  return offset_of({x_m, 0, 0}, frame, frame.key(std::array<std::int64_t, 3>{0, 0, 0}));
}

TEST(VoxelSteps, AreAPowerOfTwoOfTheVoxel) {
  const auto step_m = [](double voxel_m) { return VoxelSteps(voxel_m).step_m(); };
  for (const double voxel_m : {0.001, 0.3, 2.0, 3.0, std::nextafter(4.0, 0.0)}) EXPECT_EQ(step_m(voxel_m), 0x1p-30);
  EXPECT_EQ(step_m(4.0), 0x1p-29);
  EXPECT_EQ(step_m(7.9), 0x1p-29);
  EXPECT_EQ(step_m(8.0), 0x1p-28);
  EXPECT_EQ(step_m(1000.0), 0x1p-22);
}

TEST(VoxelSteps, RoundToTheNearest) {
  EXPECT_EQ(steps_in_first_voxel(0x1.8p-1, 3.0), (OffsetSteps{3u << 28, 0, 0}));
  EXPECT_EQ(steps_in_first_voxel(5.25 * 0x1p-30, 3.0)[0], 5U);
  EXPECT_EQ(steps_in_first_voxel(5.75 * 0x1p-30, 3.0)[0], 6U);
  EXPECT_EQ(steps_in_first_voxel(-1.0, 3.0)[0], 0U) << "no farther than the corner";
  const double voxel_m = std::nextafter(4.0, 0.0);
  EXPECT_EQ(steps_in_first_voxel(std::nextafter(voxel_m, 0.0), voxel_m)[0], kFarthest) << "not beyond 32 bits";
}

TEST(VoxelSteps, APointAtAFaceStaysInItsVoxel) {
  const double voxel_m = 0.1;
  const VoxelFrame frame(kBox, voxel_m);
  const auto most = static_cast<std::uint32_t>(std::ceil(voxel_m / VoxelSteps(voxel_m).step_m()));
  int n_below = 0;
  for (int i = -400; i < 400; ++i) {
    const double corner_m = i * voxel_m;
    for (const double x_m : {std::nextafter(corner_m, -100.0), corner_m, std::nextafter(corner_m, 100.0)}) {
      const VoxelKey key = frame.key(Eigen::Vector3d(x_m, 0, 0));
      EXPECT_LE(offset_of({x_m, 0, 0}, frame, key)[0], most) << x_m;
      n_below += x_m < static_cast<double>(frame.index(key)[0]) * voxel_m ? 1 : 0;
    }
  }
  EXPECT_GT(n_below, 0) << "some are below their voxel's rounded corner";
}

TEST(VoxelSteps, AreTheSameInEveryFrame) {
  const double voxel_m = 0.3;
  const VoxelFrame whole(kBox, voxel_m), tile({{20, -7, 3}, {30, 1, 40}}, voxel_m);
  std::mt19937_64 random(4);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d world = Eigen::Vector3d(20, -7, 3) + test::uniform_point(random, 8.0f).cast<double>();
    EXPECT_EQ(offset_of(world, tile, tile.key(world)), offset_of(world, whole, whole.key(world)));
  }
}

TEST(GaussianPairs, NeitherOrderNorOtherPointsChangeABit) {
  const test::Clouds clouds = test::two_sheets();
  // Two points far away move the curve along which points are sorted, and the frame.
  test::Clouds wider{test::permuted(clouds.reference, 5), test::permuted(clouds.estimate, 6)};
  for (PointCloud* cloud : {&wider.reference, &wider.estimate}) {
    cloud->colors = {};
    cloud->positions.push_back({-311, 170, 0});
    cloud->positions.push_back({95, -400, 77});
  }
  for (const double voxel_m : {0.7, 3.0, 5.0}) {
    const std::vector<GaussianPair> expected = gaussian_pairs(clouds.pair(), voxel_m, 3);
    const std::vector<GaussianPair> found = gaussian_pairs(wider.pair(), voxel_m, 3);
    ASSERT_GT(expected.size(), 10U);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].index, expected[i].index);
      expect_same_bits(found[i].reference, expected[i].reference);
      expect_same_bits(found[i].estimate, expected[i].estimate);
    }
  }
}

}  // namespace voxel_moments_test
}  // namespace cmap
