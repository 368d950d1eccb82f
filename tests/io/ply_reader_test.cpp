#include <sys/resource.h>

#include <limits>

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace ply_reader_test {

using ::testing::HasSubstr;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

std::string header(std::string_view format, std::string_view body) {
  return "ply\nformat " + std::string(format) + " 1.0\n" + std::string(body) + "end_header\n";
}
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kRgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
std::string vertices(std::size_t n, std::string_view properties) {
  return "element vertex " + std::to_string(n) + "\n" + std::string(properties);
}

TEST(PlyReader, Ascii) {
  const auto file = read_content("a.ply", header("ascii", "comment by hand\nobj_info x\n" + vertices(2, kXyz + kRgb)) +
                                              "1 2.5 -3e0 255 0 7\n\n  4\t5 6 1 2 3  \n");
  EXPECT_EQ(file.info.format, "PLY ascii");
  EXPECT_EQ(file.info.points, 2U);
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2.5, -3));
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{255, 0, 7}, {1, 2, 3}}));
  EXPECT_TRUE(file.info.notes.empty());
}

std::string with_line_ends(std::string_view text, std::string_view end) {
  std::string other;
  for (const char c : text) other += c == '\n' ? std::string(end) : std::string(1, c);
  return other;
}

TEST(PlyReader, LineEndsAndByteOrderMark) {
  const std::string ascii = header("ascii", vertices(1, kXyz)),
                    binary = header("binary_little_endian", vertices(1, kXyz));
  // The body begins with the byte of a line feed: it belongs to the number, not to the header's last line.
  const std::string body = Bytes().put(0.0F, 2.0F, 3.0F).set(0, '\n').str();
  for (const std::string_view end : {"\n", "\r\n", "\r"}) {
    for (const std::string_view mark : {"", "\xef\xbb\xbf"}) {
      EXPECT_EQ(point(read_content("a.ply", std::string(mark) + with_line_ends(ascii + "1 2 3\n", end)), 0),
                Eigen::Vector3d(1, 2, 3));
      const auto file = read_content("a.ply", std::string(mark) + with_line_ends(binary, end) + body);
      EXPECT_EQ(point(file, 0).tail<2>(), Eigen::Vector2d(2, 3));
    }
  }
}

TEST(PlyReader, NamesInAnyCaseAndTypesThatAreNotNeeded) {
  const std::string properties =
      "property double X\nproperty double Y\nproperty double Z\nproperty bool seen\nproperty uchar Red\n"
      "property uchar Green\nproperty uchar Blue\nproperty int64 stamp\n";
  Bytes bytes(header("binary_little_endian", vertices(1, properties)));
  bytes.put(1.0, 2.0, 3.0, U8{1}, U8{10}, U8{20}, U8{30}, std::int64_t{5});
  const auto file = read_content("a.ply", bytes.str());
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}}));
  EXPECT_THAT(all_notes(file), HasSubstr("fields not used: seen, stamp"));
}

TEST(PlyReader, BytesLeftOverAreAnError) {
  // A property that the header leaves out: every point is one byte longer than it says.
  Bytes bytes(header("binary_little_endian", vertices(3, kXyz + kRgb)));
  for (int i = 0; i < 3; ++i) bytes.put(static_cast<float>(i), 2.0F, 3.0F, U8{1}, U8{2}, U8{3}, U8{255});
  EXPECT_THAT(refusal("a.ply", bytes.str()),
              HasSubstr("3 bytes are left over after all that the header says, exactly 1 a point"));
  Bytes one(header("binary_little_endian", vertices(1, kXyz)));
  one.put(1.0F, 2.0F, 3.0F);
  EXPECT_EQ(read_content("a.ply", Bytes(one.str()).text("\n").str()).cloud.size(), 1U) << "a line end is no point";
  EXPECT_THAT(refusal("a.ply", Bytes(one.str()).put(4.0F, 5.0F, 6.0F).str()), HasSubstr("exactly 12 a point"));
}

TEST(PlyReader, RowsBeyondTheCountAreSaid) {
  const auto file = read_content("a.ply", header("ascii", vertices(1, kXyz)) + "1 2 3\n4 5 6\n\n7 8 9\n");
  EXPECT_EQ(file.cloud.size(), 1U);
  EXPECT_THAT(all_notes(file), HasSubstr("2 more lines follow"));
}

std::string warnings_of(const PointCloudFile& file) {
  std::string text;
  for (const Warning& warning : file.info.warnings) text += warning.id + ": " + warning.message + "\n";
  return text;
}

TEST(PlyReader, MeshesAreNamed) {
  const std::string face = "element face 2\nproperty list uchar int vertex_indices\n";
  const std::string colored = face + "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_THAT(
      warnings_of(read_content("a.ply", header("ascii", vertices(3, kXyz) + face) + points + "3 0 1 2\n3 2 1 0\n")),
      HasSubstr("mesh of 2 faces"));
  EXPECT_THAT(warnings_of(read_content(
                  "a.ply", header("ascii", vertices(3, kXyz) + colored) + points + "3 0 1 2 9 9 9\n3 2 1 0 9 9 9\n")),
              HasSubstr("only the faces of the mesh have colors"));
}

TEST(PlyReader, ATextThatEndsWithinItsLastFaceIsSaid) {
  const std::string whole =
      header("ascii", vertices(3, kXyz) + "element face 2\nproperty list uchar int vertex_indices\n") +
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0\n";
  EXPECT_THAT(warnings_of(read_content("a.ply", whole)), ::testing::Not(HasSubstr("ends early")));
  EXPECT_THAT(warnings_of(read_content("a.ply", whole.substr(0, whole.size() - 1))),
              ::testing::Not(HasSubstr("ends early")))
      << "a last line without its end is whole";
  for (const std::size_t missing : {2U, 3U, 5U, 7U, 8U}) {
    EXPECT_THAT(warnings_of(read_content("a.ply", whole.substr(0, whole.size() - missing))),
                HasSubstr("after 1 of 2 rows of 'face'"))
        << missing;
  }
}

TEST(PlyReader, AFileThatEndsWithinItsFacesIsSaid) {
  const std::string face = "element face 2\nproperty list uchar int vertex_indices\n";
  Bytes bytes(header("binary_little_endian", vertices(1, kXyz) + face));
  bytes.put(1.0F, 2.0F, 3.0F, U8{3}, 0, 0, 0, U8{3}, 0, 0, 0);
  EXPECT_THAT(warnings_of(read_content("a.ply", bytes.str())), ::testing::Not(HasSubstr("ends early")));
  for (std::size_t missing = 1; missing <= 26; ++missing) {
    const auto file = read_content("a.ply", bytes.str().substr(0, bytes.str().size() - missing));
    EXPECT_THAT(warnings_of(file),
                HasSubstr(missing <= 13 ? "after 1 of 2 rows of 'face'" : "after 0 of 2 rows of 'face'"));
  }
  EXPECT_THAT(warnings_of(read_content("a.ply", header("ascii", vertices(1, kXyz) + face) + "1 2 3\n3 0 0 0\n")),
              HasSubstr("after 1 of 2 rows of 'face'"));
}

TEST(PlyReader, BinaryOfBothByteOrders) {
  for (const bool big : {false, true}) {
    Bytes bytes(header(big ? "binary_big_endian" : "binary_little_endian", vertices(2, kXyz + kRgb)), big);
    bytes.put(1.0F, 2.0F, 3.0F, U8{10}, U8{20}, U8{30}, 4.0F, 5.0F, 6.0F, U8{40}, U8{50}, U8{60});
    const auto file = read_content("b.ply", bytes.str());
    EXPECT_EQ(file.info.format, big ? "PLY binary big endian" : "PLY binary little endian");
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5, 6));
    EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{10, 20, 30}, {40, 50, 60}}));
  }
}

TEST(PlyReader, AnyOrderAndTypeOfProperties) {
  for (const bool big : {false, true}) {
    const std::string properties =
        "property uchar label\nproperty ushort b\nproperty short z\nproperty double x\nproperty ushort r\n"
        "property char flag\nproperty uint y\nproperty ushort g\nproperty int id\n";
    Bytes bytes(header(big ? "binary_big_endian" : "binary_little_endian", vertices(1, properties)), big);
    bytes.put(U8{9}, U16{3000}, std::int16_t{-30}, 0.125, U16{1000}, std::int8_t{-1}, 70000U, U16{2000}, -5);
    const auto file = read_content("b.ply", bytes.str());
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(0.125, 70000, -30));
    EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb16>{{1000, 2000, 3000}}));
  }
}

TEST(PlyReader, FloatColorsStayFloats) {
  const std::string colors = "property float diffuse_red\nproperty float diffuse_green\nproperty float diffuse_blue\n";
  Bytes bytes(header("binary_little_endian", vertices(1, kXyz + colors)));
  bytes.put(1.0F, 2.0F, 3.0F, 0.0F, 0.3F, 1.0F);
  EXPECT_EQ(read_content("b.ply", bytes.str()).cloud.colors, Colors(Array<RgbF>{{0.0F, 0.3F, 1.0F}}));
}

TEST(PlyReader, ListsAndForeignElementsAreSteppedOver) {
  const std::string body =
      "element face 2\nproperty list uchar int vertex_indices\nproperty float quality\nelement empty 5\n"
      "element camera 1\nproperty double f\n" +
      vertices(2,
               "property float x\nproperty list ushort double l\nproperty float y\n"
               "property list uchar uchar m\nproperty float z\nproperty uchar red\n"
               "property uchar green\nproperty uchar blue\n") +
      "element edge 1\nproperty int a\n";
  for (const bool big : {false, true}) {
    Bytes bytes(header(big ? "binary_big_endian" : "binary_little_endian", body), big);
    bytes.put(U8{3}, 1, 2, 3, 0.5F).put(U8{0}, 0.5F).put(500.0);
    bytes.put(1.0F, U16{2}, 8.0, 9.0, 2.0F, U8{1}, U8{77}, 3.0F, U8{1}, U8{2}, U8{3});
    bytes.put(4.0F, U16{0}, 5.0F, U8{0}, 6.0F, U8{4}, U8{5}, U8{6});
    EXPECT_THAT(refusal("l.ply", bytes.str()), HasSubstr("truncated: 1 rows of element 'edge'"));
    const auto file = read_content("l.ply", bytes.put(7).str());
    EXPECT_EQ(point(file, 0), Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5, 6));
    EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{1, 2, 3}, {4, 5, 6}}));
  }
  const auto file = read_content(
      "l.ply", header("ascii", body) + "3 1 2 3 0.5\n0 0.5\n500\n1 2 8 9 2 1 77 3 1 2 3\n4 0 5 0 6 4 5 6\n1\n");
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{1, 2, 3}, {4, 5, 6}}));
}

TEST(PlyReader, ManyPointsWithListsAcrossBlocks) {
  constexpr int kPoints = 100000;
  Bytes bytes(header("binary_little_endian", vertices(kPoints, "property list uchar float l\n" + kXyz)));
  for (int i = 0; i < kPoints; ++i) {
    bytes.put(static_cast<U8>(i % 5));
    for (int j = 0; j < i % 5; ++j) bytes.put(0.0F);
    bytes.put(static_cast<float>(i), 1.0F, 2.0F);
  }
  const auto file = read_content("l.ply", bytes.str());
  ASSERT_EQ(file.cloud.size(), static_cast<std::size_t>(kPoints));
  for (std::size_t i = 0; i < kPoints; ++i) ASSERT_EQ(file.cloud.positions[i].x(), static_cast<float>(i));
}

TEST(PlyReader, NonFinitePointsAreDroppedAndCounted) {
  constexpr std::size_t kPoints = 10000;
  Bytes bytes(header("binary_little_endian", vertices(kPoints, kXyz + kRgb)));
  for (std::size_t i = 0; i < kPoints; ++i) {
    std::array<float, 3> p{static_cast<float>(i), 0.0F, 0.0F};
    if (i % 3 == 0) p[i % 9 / 3] = i % 2 == 0 ? kNaN : (i % 4 == 1 ? kInf : -kInf);
    bytes.put(p[0], p[1], p[2], static_cast<U8>(i), U8{0}, U8{0});
  }
  const auto file = read_content("n.ply", bytes.str());
  EXPECT_EQ(file.info.points, kPoints);
  ASSERT_EQ(file.info.finite_points, kPoints - (kPoints + 2) / 3);
  const auto& colors = std::get<Array<Rgb8>>(file.cloud.colors);
  ASSERT_EQ(colors.size(), file.cloud.size());
  for (std::size_t i = 0; i < file.cloud.size(); ++i) {
    const std::size_t original = i / 2 * 3 + 1 + i % 2;
    ASSERT_EQ(file.cloud.positions[i].x(), static_cast<float>(original));
    ASSERT_EQ(colors[i][0], static_cast<U8>(original));
  }
}

TEST(PlyReader, FloatCoordinatesNearZeroStayAsTheyAre) {
  Bytes bytes(header("binary_little_endian", vertices(2, kXyz)));
  bytes.put(0.1F, 1e-30F, -7.7F, 0.3F, -0.0F, 8.1F);
  const auto file = read_content("f.ply", bytes.str());
  EXPECT_EQ(file.cloud.origin, Eigen::Vector3d::Zero());
  EXPECT_EQ(file.cloud.positions[0], Eigen::Vector3f(0.1F, 1e-30F, -7.7F));
  EXPECT_EQ(file.cloud.positions[1], Eigen::Vector3f(0.3F, -0.0F, 8.1F));
}

TEST(PlyReader, LargeDoubleCoordinatesKeepTheirPrecision) {
  Bytes bytes(header("binary_little_endian", vertices(2, "property double x\nproperty double y\nproperty double z\n")));
  bytes.put(499987.1234, 4000012.4321, 101.5, 500010.0001, 3999990.0002, 99.0);
  const auto file = read_content("u.ply", bytes.str());
  EXPECT_NE(file.cloud.origin.x(), 0.0);
  EXPECT_LT((point(file, 0) - Eigen::Vector3d(499987.1234, 4000012.4321, 101.5)).norm(), 1e-5);
  EXPECT_LT((point(file, 1) - Eigen::Vector3d(500010.0001, 3999990.0002, 99.0)).norm(), 1e-5);
}

TEST(PlyReader, LargeFloatCoordinatesAreRebasedExactly) {
  Bytes bytes(header("binary_little_endian", vertices(2, kXyz)));
  bytes.put(500000.25F, 4000000.5F, 1.0F, 500001.0F, 4000003.0F, 2.0F);
  const auto file = read_content("u.ply", bytes.str());
  EXPECT_NE(file.cloud.origin.y(), 0.0);
  EXPECT_EQ(point(file, 0), Eigen::Vector3d(500000.25, 4000000.5, 1.0));
  EXPECT_EQ(point(file, 1), Eigen::Vector3d(500001.0, 4000003.0, 2.0));
}

TEST(PlyReader, AsciiAndBinaryOfTheSameFloatsAgree) {
  const std::string properties = kXyz;
  Bytes bytes(header("binary_little_endian", vertices(1, properties)));
  bytes.put(0.1F, 16777217.0F, 3.3333333F);
  expect_same_cloud(read_content("a.ply", bytes.str()).cloud,
                    read_content("b.ply", header("ascii", vertices(1, properties)) + "0.1 16777217 3.3333333\n").cloud);
}

TEST(PlyReader, ColorThatIsNotThereIsSaid) {
  const auto file = read_content("c.ply", header("ascii", vertices(1, kXyz + "property uchar red\n")) + "1 2 3 4\n");
  EXPECT_FALSE(file.cloud.has_color());
  EXPECT_THAT(all_notes(file), HasSubstr("only 1 of the three"));
}

TEST(PlyReader, Sha256CoversTrailingBytes) {
  Bytes bytes(header("ascii", vertices(1, kXyz)) + "1 2 3\ntrailing");
  const auto file = read_content("t.ply", bytes.str(), {.sha256 = true});
  EXPECT_EQ(file.info.sha256.size(), 64U);
  const auto other = read_content("t.ply", bytes.text("x").str(), {.sha256 = true});
  EXPECT_NE(file.info.sha256, other.info.sha256);
}

struct BadCase {
  std::string content, message;
};

TEST(PlyReader, BadHeaders) {
  const BadCase kCases[] = {
      {"ply\nformat ascii 1.0\n", "line 2: truncated: the file ends before 'end_header'"},
      {"ply\nformat ascii 2.0\nend_header\n", "line 2: PLY version '2.0'"},
      {"ply\nformat middle 1.0\nend_header\n", "line 2: PLY format 'middle'"},
      {"ply\nelement vertex 1\n" + kXyz + "end_header\n1 2 3\n", "without a line 'format'"},
      {header("ascii", vertices(1, kXyz + "property long n\n")),
       "line 7: unknown property type 'long' in element 'vertex'"},
      {header("ascii", "element vertex -1\n" + kXyz), "line 3: '-1' is not the number of elements 'vertex'"},
      {header("ascii", "element vertex 1e3\n" + kXyz), "line 3: '1e3'"},
      {header("ascii", "property float x\n"), "line 3: a property before any element"},
      {header("ascii", "element point 1\n" + kXyz), "no element 'vertex'"},
      {header("ascii", vertices(1, kXyz) + vertices(1, kXyz)), "declared twice"},
      {header("ascii", vertices(1, kXyz + "property float x\n")), "'x' is declared twice"},
      {header("ascii", vertices(1, "property float x\nproperty float z\n")), "no field 'y'"},
      {header("ascii", vertices(1, "property list uchar float x\nproperty float y\nproperty float z\n")),
       "'x' is not a single number"},
      {header("ascii", vertices(1, "property list float float x\n")), "line 4: the length of a list"},
      {header("ascii", vertices(1, kXyz + "property float f_dc_0\n")), "Gaussian splats"},
      {header("ascii", "wibble\n"), "line 3: unknown PLY keyword 'wibble'"},
      {header("ascii", vertices(0, kXyz)), "holds no points"},
  };
  for (const auto& [content, message] : kCases) EXPECT_THAT(refusal("bad.ply", content), HasSubstr(message));
}

TEST(PlyReader, BadAsciiBodies) {
  const std::string xyz = header("ascii", vertices(2, kXyz));
  const std::string colored = header("ascii", vertices(1, kXyz + kRgb));
  const BadCase kCases[] = {
      {xyz + "1 2 3\n", "truncated"},
      {xyz + "1.0 2.0 3.0\n", "line 8: truncated: the file ends after 1 of 2 points"},
      {xyz + "1 2 3\n44444 5\n", "line 9: ends before the value of 'z'"},
      {xyz + "1 2 3 4\n4 5 6\n", "line 8: '4' follows the last"},
      {xyz + "1 x 3\n4 5 6\n", "line 8: 'y': 'x' is not a number"},
      {xyz + "1 1,5 3\n4 5 6\n", "line 8: 'y': '1,5' is not a number"},
      {xyz + "nan nan nan\n1 inf 2\n", "none of its 2 points is finite"},
      {colored + "1 2 3 256 0 0\n", "line 11: 'red': '256' is not of type uint8"},
      {colored + "1 2 3 0 -1 0\n", "'green': '-1' is not of type uint8"},
      {colored + "1 2 3 0 0 0.5\n", "'blue': '0.5' is not of type uint8"},
  };
  for (const auto& [content, message] : kCases) EXPECT_THAT(refusal("bad.ply", content), HasSubstr(message));
}

TEST(PlyReader, TruncatedBinaryBodies) {
  Bytes bytes(header("binary_little_endian", vertices(2, kXyz)));
  const std::size_t start = bytes.str().size();
  bytes.put(1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F);
  for (std::size_t size = start; size < bytes.str().size(); ++size) {
    EXPECT_THAT(refusal("t.ply", bytes.str().substr(0, size)), HasSubstr("truncated")) << size;
  }
  Bytes lists(header("binary_little_endian", vertices(1, kXyz + "property list uint float l\n")));
  lists.put(1.0F, 2.0F, 3.0F, 4000000000U);
  EXPECT_THAT(refusal("t.ply", lists.str()), HasSubstr("truncated: a row of element 'vertex'"));
  Bytes negative(header("binary_little_endian", vertices(1, kXyz + "property list int float l\n")));
  negative.put(1.0F, 2.0F, 3.0F, -1);
  EXPECT_THAT(refusal("t.ply", negative.str()), HasSubstr("a list of length -1"));
}

/// Limits the address space for as long as it lives, so that a huge allocation fails.
class MemoryLimit {
 public:
  MemoryLimit() {
    getrlimit(RLIMIT_AS, &old_);
    rlimit limit = old_;
    limit.rlim_cur = std::min<rlim_t>(old_.rlim_cur, rlim_t{4} << 30);
    setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &old_); }

 private:
  rlimit old_{};
};

TEST(PlyReader, AbsurdCountsAreRefusedWithoutAllocating) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const MemoryLimit limit;
#endif
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* count :
         {"1000000000000000", "18446744073709551615", "1537228672809129302", "6148914691236517206"}) {
      for (const char* before : {"", "element face 18446744073709551615\nproperty list uchar int i\n",
                                 "element edge 6148914691236517206\nproperty int a\nproperty double b\n"}) {
        for (const char* list : {"", "property list uchar float l\n"}) {
          const std::string body = std::string(before) + "element vertex " + count + "\n" + kXyz + list;
          EXPECT_THAT(refusal("absurd.ply", header(format, body) + std::string(1000, '1')), HasSubstr("truncated"));
        }
      }
    }
  }
}

TEST(PlyReader, ManyEmptyRowsTakeNoTime) {
  Bytes bytes(header("binary_little_endian", "element nothing 18446744073709551615\n" + vertices(1, kXyz)));
  EXPECT_EQ(point(read_content("e.ply", bytes.put(1.0F, 2.0F, 3.0F).str()), 0), Eigen::Vector3d(1, 2, 3));
}

TEST(PlyReader, MillionsOfPropertiesAreRefused) {
  std::string properties = kXyz;
  for (int i = 0; i < 20000; ++i) properties += "property double p" + std::to_string(i) + "\n";
  EXPECT_THAT(refusal("wide.ply", header("binary_little_endian", vertices(1, properties))), HasSubstr("65536 bytes"));
}

}  // namespace ply_reader_test
}  // namespace cmap::testing
