#include <limits>

#include "containers/lzf_codec.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace pcd_reader_test {

using ::testing::HasSubstr;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Header {
  std::string fields = "x y z", sizes = "4 4 4", types = "F F F", counts = "1 1 1";
  std::string viewpoint = "0 0 0 1 0 0 0";
  std::string width = "1", height = "1", points = "1";
  std::string data = "ascii";

  std::string str() const {
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " +
           types + "\nCOUNT " + counts + "\nWIDTH " + width + "\nHEIGHT " + height + "\nVIEWPOINT " + viewpoint +
           "\nPOINTS " + points + "\nDATA " + data + "\n";
  }
};

Header with_points(Header header, std::size_t n) {
  header.width = header.points = std::to_string(n);
  return header;
}
Header with_data(Header header, std::string data) {
  header.data = std::move(data);
  return header;
}
const Header kPacked{.fields = "x y z rgb", .sizes = "4 4 4 4", .types = "F F F F", .counts = "1 1 1 1"};

std::string compressed(const Header& header, const std::string& columns) {
  const auto body = lzf_shrink(std::as_bytes(std::span(columns)));
  Bytes bytes(header.str());
  bytes.put(static_cast<std::uint32_t>(body.size()), static_cast<std::uint32_t>(columns.size()));
  return bytes.text({reinterpret_cast<const char*>(body.data()), body.size()}).str();
}

TEST(PcdReader, Ascii) {
  const auto file = read_content("a.pcd", with_points({}, 2).str() + "1 2.5 -3\n4 5 6\n");
  EXPECT_EQ(file.info.format, "PCD ascii");
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2.5, -3));
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5, 6));
  EXPECT_FALSE(file.cloud.has_color());
  EXPECT_TRUE(file.info.notes.empty());
}

TEST(PcdReader, BinaryWithPackedColor) {
  // 0xff in the alpha byte makes the float a NaN; its bits are the color all the same.
  for (const char* type : {"F F F F", "F F F U", "F F F I"}) {
    for (const char* name : {"x y z rgb", "x y z rgba"}) {
      Header header = with_data(kPacked, "binary");
      header.fields = name;
      header.types = type;
      const auto file = read_content("b.pcd", Bytes(header.str()).put(1.0F, 2.0F, 3.0F, 0xff0a141eU).str());
      EXPECT_EQ(file.info.format, "PCD binary");
      EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}}));
    }
  }
}

std::string warning_of(const PointCloudFile& file) {
  EXPECT_EQ(file.info.warnings.size(), 1U);
  return file.info.warnings.empty() ? "" : file.info.warnings[0].message;
}

/// 13132850 is 0x00c86432, the color 200 100 50; as the value of a float, and not its bits, it has lost digits.
TEST(PcdReader, PackedColorsWhoseValueIsTheInteger) {
  for (const char* number : {"1.313285e+07", "4.291351e+09", "4.291350580000000000e+09", "4291350528.0"}) {
    const auto file = read_content("a.pcd", with_points(kPacked, 2).str() + "1 2 3 " + number + "\n4 5 6 0\n");
    EXPECT_FALSE(file.cloud.has_color()) << number;
    EXPECT_THAT(warning_of(file), HasSubstr("no color: 1 packed colors are floats whose value is the packed integer"));
  }
  const auto exact = read_content("a.pcd", with_points(kPacked, 1).str() + "1 2 3 13132850.000000\n");
  EXPECT_EQ(exact.cloud.colors, Colors(Array<Rgb8>{{200, 100, 50}})) << "below 2^24 no digit is lost";
  const auto binary =
      read_content("b.pcd", Bytes(with_data(kPacked, "binary").str()).put(1.0F, 2.0F, 3.0F, 13132850.0F).str());
  EXPECT_FALSE(binary.cloud.has_color());
  EXPECT_THAT(warning_of(binary), HasSubstr("1.31328e+07"));
}

/// With an opacity of 255 the integers are beyond 2^31, where floats come in steps of 256: no blue is left.
TEST(PcdReader, PackedIntegersThatHaveBeenFloats) {
  std::string rows;
  for (unsigned i = 0; i < 20; ++i) {
    rows += std::to_string(i) + " 2 3 " + std::to_string(0xff000000U + 0x010100U * i) + "\n";
  }
  const auto file = read_content("a.pcd", with_points(kPacked, 20).str() + rows);
  EXPECT_FALSE(file.cloud.has_color());
  EXPECT_THAT(warning_of(file), HasSubstr("multiples of 256"));
  EXPECT_TRUE(
      read_content("a.pcd", with_points(kPacked, 19).str() + rows.substr(0, rows.rfind("19 2"))).cloud.has_color());
}

/// The bits of 255 128 64, 0x00ff8040, are those of 2.3464059e-38; six digits leave 0x00ff805d.
TEST(PcdReader, PackedColorsPrintedWithFewDigits) {
  const auto six = read_content("a.pcd", with_points(kPacked, 1).str() + "1 2 3 2.34641e-38\n");
  EXPECT_EQ(six.cloud.colors, Colors(Array<Rgb8>{{255, 128, 0x5d}}));
  EXPECT_THAT(warning_of(six),
              HasSubstr("1 of 1 packed colors are printed with too few digits (2.34641e-38): blue may be "
                        "off by 36 of 255"));
  for (const char* number : {"2.34640591e-38", "2.3464059e-38"}) {
    const auto file = read_content("a.pcd", with_points(kPacked, 1).str() + "1 2 3 " + number + "\n");
    EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{255, 128, 64}})) << number;
    EXPECT_TRUE(file.info.warnings.empty()) << number;
  }
}

TEST(PcdReader, AsciiPackedColorAsIntegerAndAsFloat) {
  Header header = with_points(kPacked, 4);
  const Colors expected(Array<Rgb8>{{10, 20, 30}, {10, 20, 30}, {10, 20, 30}, {0, 0, 0}});
  // 9.2556e-40 is the float whose bits are 0x000a141e; 4278850590 is 0xff0a141e.
  const std::string rows = "1 2 3 660510\n1 2 3 4278850590\n1 2 3 9.255717e-40\n1 2 3 0\n";
  EXPECT_EQ(read_content("a.pcd", header.str() + rows).cloud.colors, expected);
  header.types = "F F F U";
  EXPECT_EQ(read_content("a.pcd", with_points(header, 1).str() + "1 2 3 4278850590\n").cloud.colors,
            Colors(Array<Rgb8>{{10, 20, 30}}));
}

TEST(PcdReader, SeparateColorsAndFieldsOfSeveralValues) {
  const Header header{.fields = "h _ b y g x r z",
                      .sizes = "4 1 1 8 1 4 1 2",
                      .types = "F U U F U F U I",
                      .counts = "3 5 1 1 1 1 1 1",
                      .data = "binary"};
  Bytes bytes(header.str());
  bytes.put(7.0F, 7.0F, 7.0F).text("_____").put(U8{30}, 2.25, U8{20}, 1.5F, U8{10}, std::int16_t{-3});
  const auto file = read_content("s.pcd", bytes.str());
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(1.5, 2.25, -3));
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}}));
  const auto ascii = read_content("s.pcd", with_data(header, "ascii").str() + "7 7 7 0 0 0 0 0 30 2.25 20 1.5 10 -3\n");
  expect_same_cloud(ascii.cloud, file.cloud);
}

TEST(PcdReader, CompressedColumns) {
  constexpr std::size_t kPoints = 5000;
  const Header header = with_points({.fields = "x n y z rgb",
                                     .sizes = "4 2 4 4 4",
                                     .types = "F U F F U",
                                     .counts = "1 3 1 1 1",
                                     .data = "binary_compressed"},
                                    kPoints);
  std::string columns;
  const auto column = [&](auto value_of) {
    Bytes bytes;
    for (std::size_t i = 0; i < kPoints; ++i) bytes.put(value_of(i));
    columns += bytes.str();
  };
  column([](std::size_t i) { return i % 10 == 9 ? kNaN : static_cast<float>(i); });
  for (int k = 0; k < 3; ++k) column([](std::size_t) { return U16{7}; });
  column([](std::size_t) { return 2.0F; });
  column([](std::size_t) { return 3.0F; });
  column([](std::size_t i) { return static_cast<std::uint32_t>(i & 0xff) << 16; });
  const auto file = read_content("c.pcd", compressed(header, columns));
  EXPECT_EQ(file.info.format, "PCD compressed");
  EXPECT_EQ(file.info.points, kPoints);
  ASSERT_EQ(file.info.finite_points, kPoints / 10 * 9);
  EXPECT_EQ(point(file, 9), Eigen::Vector3d(10, 2, 3));
  EXPECT_EQ(std::get<Array<Rgb8>>(file.cloud.colors)[9], (Rgb8{10, 0, 0}));
}

TEST(PcdReader, OrganizedCloudsAndViewpoints) {
  Header header{.viewpoint = "0 0 1 1 0 0 0", .width = "2", .height = "2", .points = "4"};
  const auto file = read_content("o.pcd", header.str() + "1 2 3\nnan nan nan\n1 2 4\n1 2 5\n");
  EXPECT_EQ(file.info.points, 4U);
  EXPECT_EQ(file.info.finite_points, 3U);
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 3)) << "the viewpoint is not applied";
  EXPECT_THAT(all_notes(file), HasSubstr("VIEWPOINT"));
  ASSERT_EQ(file.info.sensor_positions.size(), 1U);
  EXPECT_EQ(file.info.sensor_positions[0], Eigen::Vector3d(0, 0, 1));
}

TEST(PcdReader, UpperCaseFieldsWithColorsOfAnyType) {
  Header header{
      .fields = "X Y Z Red Green Blue", .sizes = "4 4 4 2 2 2", .types = "F F F U U U", .counts = "1 1 1 1 1 1"};
  EXPECT_EQ(read_content("a.pcd", header.str() + "1 2 3 10 20 30\n").cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}}));
  header.sizes = "4 4 4 4 4 4";
  for (const char* types : {"F F F I I I", "F F F F F F", "F F F U U U"}) {
    header.types = types;
    EXPECT_EQ(read_content("a.pcd", header.str() + "1 2 3 10 20 255\n").cloud.colors,
              Colors(Array<Rgb8>{{10, 20, 255}}));
  }
}

TEST(PcdReader, FieldsOfCountZeroTakeNoRoom) {
  Header header{.fields = "x y z _ t", .sizes = "4 4 4 1 2", .types = "F F F U U", .counts = "1 1 1 0 1"};
  EXPECT_EQ(point(read_content("a.pcd", header.str() + "1 2 3 7\n"), 0), Eigen::Vector3d(1, 2, 3));
  header.data = "binary";
  EXPECT_EQ(point(read_content("a.pcd", Bytes(header.str()).put(1.0F, 2.0F, 3.0F, U16{7}).str()), 0),
            Eigen::Vector3d(1, 2, 3));
}

TEST(PcdReader, PackedColorsLostAsNanAreNoColors) {
  const Header header = with_points(kPacked, 2);
  // The float with the bits 0x00c8141e, to nine digits.
  const auto file = read_content("a.pcd", header.str() + "1 2 3 nan\n4 5 6 1.83743159e-38\n");
  ASSERT_EQ(file.cloud.size(), 2U);
  const auto& colors = std::get<Array<RgbF>>(file.cloud.colors);
  EXPECT_TRUE(std::isnan(colors[0][0]) && std::isnan(colors[0][1]) && std::isnan(colors[0][2]));
  EXPECT_NEAR(colors[1][0] * 255.0F, 200.0F, 1e-4F);
  EXPECT_NEAR(colors[1][2] * 255.0F, 30.0F, 1e-4F);
  ASSERT_EQ(file.info.warnings.size(), 1U);
  EXPECT_THAT(file.info.warnings[0].message, HasSubstr("1 of 2 points have no color"));
  EXPECT_FALSE(read_content("a.pcd", header.str() + "1 2 3 nan\n4 5 6 nan\n").cloud.has_color());
}

TEST(PcdReader, WhatFollowsThePointsIsSaidOrRefused) {
  const std::string rows = Header{}.str() + "1 2 3\n4 5 6\n";
  EXPECT_THAT(all_notes(read_content("a.pcd", rows)), HasSubstr("1 more lines follow"));
  const Bytes binary = Bytes(with_data({}, "binary").str()).put(1.0F, 2.0F, 3.0F);
  EXPECT_THAT(refusal("a.pcd", Bytes(binary.str()).put(4.0F).str()), HasSubstr("4 bytes are left over"));
  EXPECT_EQ(read_content("a.pcd", Bytes(binary.str()).text("\n").str()).cloud.size(), 1U);
  EXPECT_THAT(all_notes(read_content("a.pcd", Bytes(binary.str()).put(std::uint64_t{0}).str())),
              HasSubstr("8 bytes of nothing"));
}

TEST(PcdReader, HeaderWithoutCommentsCountsOrPoints) {
  const std::string text =
      "VERSION .7\r\nFIELDS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nWIDTH 1\r\nHEIGHT 1\r\nDATA ascii\r\n1 2 3\r\n";
  EXPECT_EQ(point(read_content("h.pcd", text), 0), Eigen::Vector3d(1, 2, 3));
}

struct BadCase {
  std::string content, message;
};

TEST(PcdReader, BadHeaders) {
  const BadCase kCases[] = {
      {"# .PCD v0.7\nVERSION 0.7\n", "line 2: truncated: the file ends before the line DATA"},
      {"# .PCD v0.7\nCOLOR 1\n", "line 2: unknown PCD keyword 'COLOR'"},
      {"# .PCD v0.7\nDATA ascii\n", "no line FIELDS"},
      {Header{.fields = "x y"}.str(), "3 values of SIZE for 2 FIELDS"},
      {Header{.types = "F F"}.str(), "2 values of TYPE for 3 FIELDS"},
      {Header{.counts = "1"}.str(), "1 values of COUNT for 3 FIELDS"},
      {Header{.sizes = "4 4 3"}.str(), "'z' has unknown TYPE F of SIZE 3"},
      {Header{.types = "F F Q"}.str(), "'z' has unknown TYPE Q of SIZE 4"},
      {Header{.sizes = "4 4 -4"}.str(), "'-4' is not a whole number"},
      {Header{.counts = "1 1 0"}.str(), "'z' is not a single number"},
      {Header{.counts = "1 1 2"}.str(), "'z' is not a single number"},
      {Header{.counts = "1 1 99999999999"}.str(), "COUNT 99999999999"},
      {Header{.fields = "x y i"}.str(), "no field 'z'"},
      {Header{.width = "3", .height = "2", .points = "5"}.str(), "WIDTH 3 times HEIGHT 2 is not POINTS 5"},
      {Header{.width = "4294967296", .height = "4294967296", .points = "0"}.str(), "is not POINTS 0"},
      {Header{.data = "binary_big"}.str(), "DATA 'binary_big'"},
      {with_points({}, 0).str(), "holds no points"},
      {with_data(with_points({}, 0), "binary").str(), "holds no points"},
  };
  for (const auto& [content, message] : kCases) EXPECT_THAT(refusal("bad.pcd", content), HasSubstr(message));
}

TEST(PcdReader, BadBodies) {
  const BadCase kCases[] = {
      {with_points({}, 2).str() + "1 2 3\n", "truncated"},
      {Header{}.str() + "1 2 three\n", "line 12: 'z': 'three' is not a number"},
      {Header{}.str() + "nan 2 3\n", "none of its 1 points is finite"},
      {kPacked.str() + "1 2 3 -1e30\n", ""},
      {Header{kPacked.fields, kPacked.sizes, "F F F U", kPacked.counts}.str() + "1 2 3 0.5\n",
       "'0.5' is not a packed color"},
      {with_data({}, "binary").str() + "12345678901", "truncated: 1 points of 12 bytes"},
      {with_data({}, "binary_compressed").str() + "123", "truncated"},
      {Bytes(with_data({}, "binary_compressed").str()).put(100U, 12U).text("short").str(),
       "truncated: the compressed body"},
      {Bytes(with_data({}, "binary_compressed").str()).put(5U, 13U).text("short").str(), "do not make the 13 bytes"},
      {Bytes(with_data({}, "binary_compressed").str()).put(5U, 12U).text("short").str(), "compressed body is damaged"},
  };
  for (const auto& [content, message] : kCases) EXPECT_THAT(refusal("bad.pcd", content), HasSubstr(message));
}

TEST(PcdReader, AbsurdCountsAreRefused) {
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    for (const char* n : {"1000000000000000", "18446744073709551615", "1537228672809129302", "357913942"}) {
      Header header = with_data({}, data);
      header.width = header.points = n;
      EXPECT_THAT(refusal("absurd.pcd", header.str() + std::string(1000, '1')), HasSubstr("truncated"));
    }
  }
  // 4 GiB promised by a compressed body of a few bytes.
  Bytes bomb(with_data(with_points({}, 357913941), "binary_compressed").str());
  bomb.put(16U, 4294967292U).text(std::string(16, '\xff'));
  EXPECT_THAT(refusal("bomb.pcd", bomb.str()), HasSubstr("truncated"));
}

TEST(PcdReader, CompressedCoordinatesInDouble) {
  const Header header{.sizes = "8 8 8", .data = "binary_compressed"};
  const auto file = read_content("d.pcd", compressed(header, Bytes().put(500000.0625, 4000000.125, 3.0).str()));
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(500000.0625, 4000000.125, 3.0));
}

}  // namespace pcd_reader_test
}  // namespace cmap::testing
