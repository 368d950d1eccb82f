#include <cmath>
#include <limits>
#include <vector>

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace kitti_bin_reader_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A scan around its scanner: x and y of both signs, z below and above, intensity and ring.
std::vector<std::array<float, 5>> scan(std::size_t n) {
  std::vector<std::array<float, 5>> points(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto angle = static_cast<float>(i) * 0.37F;
    const float range_m = 5.0F + static_cast<float>(i % 13);
    points[i] = {range_m * std::cos(angle), range_m * std::sin(angle), static_cast<float>(i % 5) * 0.25F - 0.8F,
                 static_cast<float>(i % 100) / 100.0F, static_cast<float>(i % 32)};
  }
  return points;
}

std::string raw(const std::vector<std::array<float, 5>>& points, std::size_t n_floats) {
  Bytes bytes;
  for (const auto& point : points) {
    for (std::size_t k = 0; k < n_floats; ++k) bytes.put(point[k]);
  }
  return bytes.str();
}

void expect_scan(const PointCloudFile& file, const std::vector<std::array<float, 5>>& points) {
  ASSERT_EQ(file.info.points, points.size());
  EXPECT_FALSE(file.cloud.has_color());
  for (std::size_t i = 0; i < points.size(); i += 17) {
    EXPECT_EQ(point(file, i), Eigen::Vector3d(points[i][0], points[i][1], points[i][2])) << i;
  }
}

TEST(KittiBin, FourFloatsAPoint) {
  for (const std::size_t n : {std::size_t{12}, std::size_t{60}, std::size_t{20000}}) {
    const auto file = read_content("000000.bin", raw(scan(n), 4));
    EXPECT_EQ(file.info.format, "KITTI .bin");
    EXPECT_THAT(all_notes(file), HasSubstr("x y z intensity"));
    expect_scan(file, scan(n));
  }
}

TEST(KittiBin, IntensitiesOfOtherScanners) {
  auto points = scan(600);
  for (auto& point : points) point[3] = 40.0F * std::abs(point[0]);  // up to hundreds, with fractions
  expect_scan(read_content("a.bin", raw(points, 4)), points);
  for (auto& point : points) point[3] = 0.0F;
  expect_scan(read_content("a.bin", raw(points, 4)), points);
}

TEST(KittiBin, FiveFloatsAPointAreNuScenes) {
  // 240 points of 20 bytes are 300 of 16 as well; the ring tells.
  const auto file = read_content("a.pcd.bin", raw(scan(240), 5));
  EXPECT_EQ(file.info.format, "nuScenes .pcd.bin");
  expect_scan(file, scan(240));
}

TEST(KittiBin, UnmeasuredPointsAreDropped) {
  auto points = scan(100);
  points[7][0] = points[7][1] = points[7][2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(read_content("a.bin", raw(points, 4)).info.finite_points, 99U);
}

TEST(KittiBin, RefusesWhatMayBeAnotherLayout) {
  // Three floats a point, all positive: every fourth number would pass for an intensity.
  auto points = scan(96);
  for (auto& point : points) {
    for (float& value : point) value = std::abs(value) + 0.25F;
  }
  EXPECT_THAT(refusal("a.bin", raw(points, 3)), AllOf(HasSubstr("may be KITTI"), HasSubstr("as well as x y z")));
  // With both signs they cannot be KITTI's.
  EXPECT_THAT(refusal("a.bin", raw(scan(96), 3)), HasSubstr("is neither KITTI"));
  // All numbers small whole numbers.
  for (auto& point : points) point = {1, 2, 3, 4, 5};
  EXPECT_THAT(refusal("a.bin", raw(points, 4).substr(0, 960)), AllOf(HasSubstr("KITTI"), HasSubstr("nuScenes")));
}

TEST(KittiBin, RefusesOtherBytes) {
  EXPECT_THAT(refusal("a.bin", raw(scan(61), 4).substr(0, 970)),
              AllOf(HasSubstr("970 bytes are no whole number of points"), HasSubstr("16"), HasSubstr("20")));
  Bytes doubles;
  for (const auto& point : scan(64)) doubles.put(double{point[0]}, double{point[1]}, double{point[2]}, 0.3);
  EXPECT_THAT(refusal("a.bin", doubles.str()), HasSubstr("is neither KITTI"));
  std::string noise(960, '\0');
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<char>(i * i * 31 + i / 7);
  EXPECT_THAT(refusal("a.bin", noise), HasSubstr("is neither KITTI"));
  EXPECT_THAT(refusal("a.dat", raw(scan(60), 4)), HasSubstr("of no known format")) << "only by its extension";
}

TEST(KittiBin, EveryCutIsReadInWholePointsOrRefused) {
  const std::string good = raw(scan(40), 4);
  for (std::size_t n = 1; n < good.size(); ++n) {
    EXPECT_TRUE(n % 16 == 0 || !refusal("a.bin", good.substr(0, n)).empty()) << n;
  }
}

}  // namespace kitti_bin_reader_test
}  // namespace cmap::testing
