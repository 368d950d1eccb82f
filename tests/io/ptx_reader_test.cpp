#include "io/io_testing.hpp"

namespace cmap::testing {
namespace ptx_reader_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::string_view kIdentity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
constexpr std::string_view kAxes = "1 0 0\n0 1 0\n0 0 1\n";

std::string scan(std::string_view counts, std::string_view position, std::string_view matrix, std::string_view rows) {
  return std::string(counts) + "\n" + std::string(position) + "\n" + std::string(kAxes) + std::string(matrix) +
         std::string(rows);
}

std::string all_warnings(const PointCloudFile& file) {
  std::string warnings;
  for (const Warning& warning : file.info.warnings) warnings += warning.id + ": " + warning.message + "\n";
  return warnings;
}

// A quarter turn about z, then (100, 200, 300): x y z becomes 100 - y, 200 + x, 300 + z. As rows, the axes of the scan
// in the world.
constexpr std::string_view kQuarterTurn = "0 1 0 0\n-1 0 0 0\n0 0 1 0\n100 200 300 1\n";

TEST(PtxReader, MovesTheScanByTheRowsOfItsMatrix) {
  const auto file = read_content("a.ptx", scan("3\n1", "100 200 300", kQuarterTurn,
                                               "1 2 3 0.5 10 20 30\n0 0 0 0.5 0 0 0\n-4 5 6.5 0.25 255 0 7\n"));
  EXPECT_EQ(file.info.format, "PTX");
  EXPECT_EQ(file.info.points, 3U);
  ASSERT_EQ(file.info.finite_points, 2U);
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(98, 201, 303));
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(95, 196, 306.5));
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}, {255, 0, 7}}));
  EXPECT_THAT(file.info.sensor_positions, ::testing::ElementsAre(Eigen::Vector3d(100, 200, 300)));
  ASSERT_EQ(file.info.left_out.size(), 1U);
  EXPECT_EQ(file.info.left_out[0].n, 1U);
  EXPECT_THAT(all_warnings(file), "");
}

TEST(PtxReader, ReadsEveryScan) {
  const auto file = read_content("a.ptx", scan("1\n2", "1 2 3", kIdentity, "4 5 6 0.5\n7 8 9 0.5\n") +
                                              scan("2\n1", "100 200 300", kQuarterTurn, "1 2 3 0.5\n0 0 0 0.5\n"));
  EXPECT_EQ(file.info.format, "PTX, 2 scans");
  ASSERT_EQ(file.info.finite_points, 3U);
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(point(file, 2), Eigen::Vector3d(98, 201, 303));
  EXPECT_FALSE(file.cloud.has_color());
  EXPECT_THAT(file.info.sensor_positions,
              ::testing::ElementsAre(Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(100, 200, 300)));
}

TEST(PtxReader, EveryLineEndAndABlankLineBetweenScans) {
  const std::string unix_ends =
      scan("1\n1", "0 0 0", kIdentity, "4 5 6 0.5\n") + "\n" + scan("1\n1", "0 0 0", kIdentity, "7 8 9 0.5\n");
  std::string crlf;
  for (const char c : unix_ends) crlf += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(read_content("a.txt", unix_ends).info.finite_points, 2U);
  EXPECT_EQ(read_content("a.txt", crlf).info.finite_points, 2U);
}

TEST(PtxReader, AScaledMatrixIsAppliedAndSaid) {
  const auto file = read_content("a.ptx", scan("1\n1", "0 0 7", "1 0 0 0\n0 1 0 0\n0 0 2 0\n0 0 7 1\n", "1 2 3 0.5\n"));
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 13));
  EXPECT_THAT(all_notes(file), HasSubstr("no rotation"));
}

TEST(PtxReader, FewerRowsThanTheGridAreReadAndBothCountsSaid) {
  for (const char* counts : {"5\n3", "100000\n100000"}) {
    const auto file = read_content("a.ptx", scan(counts, "0 0 0", kIdentity, "1 2 3 0.5\n4 5 6 0.5\n"));
    EXPECT_EQ(file.info.finite_points, 2U);
    EXPECT_THAT(all_warnings(file), AllOf(HasSubstr("2 rows"), HasSubstr(counts[0] == '5' ? "15" : "10000000000")));
  }
  // In the first of two scans: the next header ends it.
  const auto file = read_content(
      "a.ptx", scan("2\n2", "0 0 0", kIdentity, "1 2 3 0.5\n") + scan("1\n1", "0 0 0", kIdentity, "4 5 6 0.5\n"));
  EXPECT_EQ(file.info.finite_points, 2U);
  EXPECT_THAT(all_warnings(file), AllOf(HasSubstr("scan 1 holds 1 rows"), HasSubstr("the 4 of its grid")));
}

TEST(PtxReader, RowsBeyondTheGridAreNotUsedAndSaid) {
  const auto file = read_content("a.ptx", scan("1\n1", "0 0 0", kIdentity, "1 2 3 0.5\n4 5 6 0.5\n7 8 9 0.5\n"));
  EXPECT_EQ(file.info.finite_points, 1U);
  EXPECT_THAT(all_warnings(file), HasSubstr("2 more rows"));
}

TEST(PtxReader, AScannerFarFromItsPointsIsNotKnown) {
  const auto file = read_content("a.ptx", scan("1\n1", "0 0 0", kIdentity, "637012.5 849028.5 431.5 0.5\n"));
  EXPECT_TRUE(file.info.sensor_positions.empty());
  EXPECT_THAT(all_notes(file), HasSubstr("scanner is not known"));
  EXPECT_NEAR(point(file, 0).x(), 637012.5, 1e-9);
}

TEST(PtxReader, ThePositionLeftAtZeroIsTheMatrix) {
  const auto file = read_content("a.ptx", scan("1\n1", "0 0 0", kQuarterTurn, "1 2 3 0.5\n"));
  EXPECT_THAT(file.info.sensor_positions, ::testing::ElementsAre(Eigen::Vector3d(100, 200, 300)));
}

TEST(PtxReader, AScanWithoutColorBesideOneWith) {
  const auto file = read_content("a.ptx", scan("1\n1", "0 0 0", kIdentity, "1 2 3 0.5 10 20 255\n") +
                                              scan("1\n1", "0 0 0", kIdentity, "4 5 6 0.5\n"));
  ASSERT_EQ(file.info.finite_points, 2U) << "it counts for geometry";
  const auto& colors = std::get<Array<RgbF>>(file.cloud.colors);
  EXPECT_NEAR(colors[0][0], 10.0 / 255.0, 1e-6);
  EXPECT_TRUE(std::isnan(colors[1][0]));
}

TEST(PtxReader, RefusesWhatIsCutOrMixedUp) {
  const std::string good = scan("1\n2", "0 0 0", kIdentity, "1 2 3 0.5\n4 5 6 0.5\n");
  const std::pair<std::string, const char*> kCases[] = {
      {good.substr(0, good.find("0 0 1 0\n")), "truncated: the file ends before the 4x4 matrix"},
      {scan("1\n2", "0 0 0", kIdentity, ""), "holds no points"},
      {scan("1\n2", "0 0 0", kIdentity, "0 0 0 0.5\n0 0 0 0.5\n"), "none of its 2 points"},
      {scan("1\n2", "0 0 0", kIdentity, "1 2 3 0.5\n4 5\n"), "line 12: 2 columns"},
      {scan("1\n2", "0 0 0", kIdentity, "1 2 3 0.5 1 2 3 4\n"), "line 11: 8 columns"},
      {scan("1\n2", "0 0 0", kIdentity, "1 2 z 0.5\n"), "line 11: column 3: 'z' is not a number"},
      {scan("1\n-2", "0 0 0", kIdentity, "1 2 3 0.5\n"), "line 2: '-2' is not the number of rows"},
      {scan("1\n1", "0 0 0", "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n", "1 2 3 0.5\n"), "translation in the last column"},
      {scan("1\n1", "0 0 0", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n", "1 2 3 0.5\n"), "not 0 0 0 1"},
      {scan("1\n1", "0 0 0", "1 0 0 0\n0 1 0 0\n0 0 0 0\n0 0 0 1\n", "1 2 3 0.5\n"), "flattens"},
      {scan("1\n1", "0 0 0", "1 0 0\n0 1 0\n0 0 1\n0 0 0 1\n", "1 2 3 0.5\n"), "line 7: '' is no number"},
      {scan("1\n1", "0 nan 0", kIdentity, "1 2 3 0.5\n"), "line 3: 'nan'"},
      {scan("10000000000\n10000000000", "0 0 0", kIdentity, "1 2 3 0.5\n"), "10000000000 columns"},
      {good + "3\n1 2 3 0.5\n", "is not the number of rows"},
  };
  for (const auto& [content, message] : kCases) EXPECT_THAT(refusal("a.ptx", content), HasSubstr(message)) << content;
}

TEST(PtxReader, EveryCutIsReadInPartOrRefused) {
  const std::string good = scan("1\n3", "0 0 0", kIdentity, "1 2 3 0.5\n4 5 6 0.5\n7 8 9 0.5\n");
  for (std::size_t n = 1; n + 8 < good.size(); ++n) {
    const std::string cut = good.substr(0, n);
    if (!refusal("a.ptx", cut).empty()) continue;
    EXPECT_THAT(all_warnings(read_content("a.ptx", cut)), HasSubstr("fewer than the 3")) << n;
  }
}

}  // namespace ptx_reader_test
}  // namespace cmap::testing
