#include <array>
#include <vector>

#include "clouds/format_readers.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::string_view kComments =
    "# 3D point list with one line of data per point:\n"
    "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n";

std::string with_comments(std::string_view rows) { return std::string(kComments) + std::string(rows); }

void expect_two_points(const PointCloudFile& file) {
  ASSERT_EQ(file.info.points, 2U);
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(1.5, -2, 3));
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5.25, 6));
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{255, 0, 7}, {10, 20, 30}}));
}

TEST(ColmapText, TracksOfAnyLength) {
  for (const char* rows : {"9 1.5 -2 3 255 0 7 0.5 1 2 3 4\n2 4 5.25 6 10 20 30 0.75 1 7 2 8\n",
                           "9 1.5 -2 3 255 0 7 0.5 1 2\n2 4 5.25 6 10 20 30 0.75 1 7 2 8 3 9\n",
                           "9 1.5 -2 3 255 0 7 0.5\n2 4 5.25 6 10 20 30 -1 \n",
                           "9 1.5 -2 3 255 0 7 0.5 \r\n\r\n2 4 5.25 6 10 20 30 0 1 2 4294967295 5"}) {
    expect_two_points(read_content("t.txt", with_comments(rows)));
    expect_two_points(read_content("points3D.txt", rows));
  }
  EXPECT_EQ(read_content("t.txt", with_comments("1 1.5 2 3 4 5 6 0.5\n")).info.format, "COLMAP points3D text");
}

TEST(ColmapText, WithoutCommentsByWhatTheRowsHold) {
  const auto file = read_content("cloud.txt",
                                 "9 1.5 -2 3 255 0 7 0.5 1 2\n2 4 5.25 6 10 20 30 0.75 1 7 2 8\n"
                                 "3 4 5.25 7 10 20 30 0.75 1 7 2 8\n");
  EXPECT_EQ(file.info.format, "COLMAP points3D text");
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5.25, 6));
}

FileStart start_of(std::string name, std::string_view text) {
  FileStart start;
  start.name = std::move(name);
  start.bytes = text;
  start.size = text.size();
  start.text = start.whole = true;
  return start;
}

TEST(ColmapText, OtherTextIsNotTakenForIt) {
  // Equal ids, fractions in the colors, an odd track, no track at all, whole coordinates.
  for (const char* text : {"1 2.5 3 4 5 6 7 8 9 10\n1 2.5 3 4 5 6 7 8 9 10\n1 2 3 4 5 6 7 8 9 1\n",
                           "1 2.5 3 4 .5 6 7 8 9 1\n2 2.5 3 4 5 6 7 8 9 1\n3 2 3 4 5 6 7 8 9 1\n",
                           "1 2.5 3 4 5 6 7 8 9\n2 2.5 3 4 5 6 7 8 9\n3 2.5 3 4 5 6 7 8 9\n",
                           "1 2.5 3 4 5 6 7 8\n2 2.5 3 4 5 6 7 8\n3 2.5 3 4 5 6 7 8\n",
                           "1 2 3 4 5 6 7 8 9 1\n2 2 3 4 5 6 7 8 9 1\n3 2 3 4 5 6 7 8 9 1\n"}) {
    EXPECT_FALSE(is_colmap_text(start_of("a.txt", text))) << text;
  }
  EXPECT_TRUE(is_colmap_text(start_of("points3d.txt", "1 2.5 3 4 5 6 7 8\n")));
}

TEST(ColmapText, AnotherCountThanTheCommentsIsSaid) {
  const auto file = read_content("points3D.txt", with_comments("# Number of points: 12, mean track length: 3.0\n"
                                                               "1 1.5 2 3 250 150 60 0.5 1 2\n"));
  ASSERT_EQ(file.info.warnings.size(), 1U);
  EXPECT_THAT(file.info.warnings[0].message, AllOf(HasSubstr("12 points"), HasSubstr("holds 1")));
  EXPECT_TRUE(read_content("a.txt", with_comments("# Number of points: 1, mean track length: 0\n1 2 3 4 250 6 7 0\n"))
                  .info.warnings.empty());
}

TEST(ColmapText, RefusesRowsThatAreNone) {
  const std::pair<const char*, const char*> kCases[] = {
      {"1 1.5 2 3 4 5 6 0.5 1\n", "line 3: the track of point 1 has 1 numbers, not pairs"},
      {"1 1.5 2 3 4 5 6\n", "line 3: not a COLMAP point"},
      {"1 1.5 2 3 4 5 256 0.5\n", "from 0 to 255"},
      {"1.5 1.5 2 3 4 5 6 0.5\n", "line 3: not a COLMAP point"},
      {"1 1.5 2 3 4 5 6 0.5 1 2.5\n", "the track of point 1 holds more than whole numbers"},
      {"1 1.5 2 3 4 5 6 0.5\n2 1.5 2", "line 4: not a COLMAP point"},
      {"", "holds no points"},
  };
  for (const auto& [rows, message] : kCases) {
    EXPECT_THAT(refusal("points3D.txt", with_comments(rows)), HasSubstr(message)) << rows;
  }
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

}  // namespace
}  // namespace cmap::testing
