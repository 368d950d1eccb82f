#include <array>
#include <vector>

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace colmap_binary_reader_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

void expect_two_points(const PointCloudFile& file) {
  ASSERT_EQ(file.info.points, 2U);
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(1.5, -2, 3));
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5.25, 6));
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{255, 0, 7}, {10, 20, 30}}));
}

using Track = std::vector<std::pair<std::int32_t, std::int32_t>>;

Bytes& put_point(Bytes& bytes, std::uint64_t id, std::array<double, 3> xyz, std::array<U8, 3> rgb, const Track& track) {
  bytes.put(id, xyz[0], xyz[1], xyz[2], rgb[0], rgb[1], rgb[2], 0.5, std::uint64_t{track.size()});
  for (const auto& [image, point2d] : track) bytes.put(image, point2d);
  return bytes;
}

std::string two_points() {
  Bytes bytes;
  bytes.put(std::uint64_t{2});
  put_point(bytes, 9, {1.5, -2, 3}, {255, 0, 7}, {{1, 2}, {3, 4}, {5, 6}});
  put_point(bytes, 2, {4, 5.25, 6}, {10, 20, 30}, {});
  return bytes.str();
}

TEST(ColmapBinary, TracksOfAnyLengthUnderAnyName) {
  for (const char* name : {"points3D.bin", "cloud.bin", "cloud"}) {
    const auto file = read_content(name, two_points());
    EXPECT_EQ(file.info.format, "COLMAP points3D binary");
    expect_two_points(file);
  }
}

TEST(ColmapBinary, MorePointsThanOneBlock) {
  constexpr std::uint64_t kPoints = 5000;
  Bytes bytes;
  bytes.put(kPoints);
  for (std::uint64_t i = 0; i < kPoints; ++i) {
    const auto x = static_cast<double>(i);
    put_point(bytes, i, {x, 0.5 * x, 1}, {static_cast<U8>(i % 256), 1, 2}, Track(i % 7, {1, 2}));
  }
  const auto file = read_content("points3D.bin", bytes.str());
  ASSERT_EQ(file.info.points, kPoints);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1023}, std::size_t{1024}, std::size_t{4999}}) {
    const auto x = static_cast<double>(i);
    EXPECT_EQ(point(file, i), Eigen::Vector3d(x, 0.5 * x, 1));
    EXPECT_EQ(std::get<Array<Rgb8>>(file.cloud.colors)[i][0], i % 256);
  }
}

TEST(ColmapBinary, EveryCutIsRefused) {
  const std::string good = two_points();
  for (std::size_t n = 1; n < good.size(); ++n) {
    EXPECT_THAT(refusal("points3D.bin", good.substr(0, n)), HasSubstr("truncated")) << n;
  }
}

TEST(ColmapBinary, CountsAreCheckedAgainstTheFile) {
  EXPECT_THAT(refusal("points3D.bin", two_points() + "12345"), HasSubstr("5 bytes left over after its 2 points"));
  for (const std::uint64_t n : {std::uint64_t{3}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    EXPECT_THAT(refusal("points3D.bin", Bytes(two_points()).set(0, n).str()), HasSubstr("truncated"));
  }
  EXPECT_THAT(refusal("points3D.bin", Bytes(two_points()).set(0, std::uint64_t{1}).str()), HasSubstr("left over"));
  for (const std::uint64_t track : {std::uint64_t{1} << 61, ~std::uint64_t{0}, std::uint64_t{100}}) {
    EXPECT_THAT(refusal("points3D.bin", Bytes(two_points()).set(8 + 43, track).str()), HasSubstr("track of"));
  }
  EXPECT_THAT(refusal("points3D.bin", std::string(8, '\0')), HasSubstr("holds no points"));
}

TEST(ColmapModel, TheOtherFilesAreNamed) {
  EXPECT_THAT(
      refusal("cameras.txt", "# Camera list with one line of data per camera:\n1 PINHOLE 640 480 5 5 320 240\n"),
      AllOf(HasSubstr("cameras of a COLMAP model"), HasSubstr("points3D.txt")));
  EXPECT_THAT(refusal("x.txt", "# Image list with two lines of data per image:\n1 1 0 0 0 0 0 0 1 a.jpg\n\n"),
              HasSubstr("images of a COLMAP model"));
  Bytes cameras;
  cameras.put(std::uint64_t{1}, std::uint32_t{1}, std::int32_t{1}, std::uint64_t{640}, std::uint64_t{480});
  cameras.put(500.0, 500.0, 320.0, 240.0);
  EXPECT_THAT(refusal("cameras.bin", cameras.str()), HasSubstr("cameras of a COLMAP model"));
  EXPECT_THAT(refusal("renamed.bin", cameras.str()), HasSubstr("is neither KITTI"));
}

}  // namespace colmap_binary_reader_test
}  // namespace cmap::testing
