#include <array>
#include <vector>

#include "clouds/cloud_format.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace colmap_text_reader_test {

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

std::string_view format_of(std::string name, std::string_view content) {
  ByteSource source(std::move(name), std::as_bytes(std::span(content)));
  return detect_format(source).name;
}

TEST(ColmapText, OtherTextIsNotTakenForIt) {
  // Equal ids, fractions in the colors, an odd track, no track at all, whole coordinates.
  for (const char* text : {"1 2.5 3 4 5 6 7 8 9 10\n1 2.5 3 4 5 6 7 8 9 10\n1 2 3 4 5 6 7 8 9 1\n",
                           "1 2.5 3 4 .5 6 7 8 9 1\n2 2.5 3 4 5 6 7 8 9 1\n3 2 3 4 5 6 7 8 9 1\n",
                           "1 2.5 3 4 5 6 7 8 9\n2 2.5 3 4 5 6 7 8 9\n3 2.5 3 4 5 6 7 8 9\n",
                           "1 2.5 3 4 5 6 7 8\n2 2.5 3 4 5 6 7 8\n3 2.5 3 4 5 6 7 8\n",
                           "1 2 3 4 5 6 7 8 9 1\n2 2 3 4 5 6 7 8 9 1\n3 2 3 4 5 6 7 8 9 1\n"}) {
    EXPECT_NE(format_of("a.txt", text), "COLMAP text") << text;
  }
  EXPECT_EQ(format_of("points3d.txt", "1 2.5 3 4 5 6 7 8\n"), "COLMAP text");
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

}  // namespace colmap_text_reader_test
}  // namespace cmap::testing
