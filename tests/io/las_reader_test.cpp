#include <limits>

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace {

using ::testing::HasSubstr;

constexpr std::array<U16, 11> kRecordBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::array<std::size_t, 11> kRgbOffset{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

/// A LAS file with these points; every record has `extra` bytes of its own at the end.
struct Las {
  U8 minor = 2;
  U8 format = 3;
  U16 extra = 0;
  std::uint32_t gap = 0;  ///< bytes between header and points
  std::array<double, 3> scale{0.01, 0.01, 0.001};
  std::array<double, 3> offset{500000, 4000000, 0};
  std::vector<std::array<std::int32_t, 3>> points{{1, 2, 3}};
  std::vector<Rgb16> colors{{256, 512, 65535}};

  std::size_t header_bytes() const { return minor == 4 ? 375 : minor == 3 ? 235 : 227; }
  std::size_t record_bytes() const { return std::size_t{kRecordBytes[format]} + extra; }

  Bytes header() const {
    Bytes bytes(std::string(header_bytes(), '\0'));
    const auto n = static_cast<std::uint32_t>(points.size());
    bytes.set(0, std::array{'L', 'A', 'S', 'F'}).set(24, U8{1}).set(25, minor);
    bytes.set(94, static_cast<U16>(header_bytes())).set(96, static_cast<std::uint32_t>(header_bytes()) + gap);
    bytes.set(104, format).set(105, static_cast<U16>(record_bytes()));
    bytes.set(131, scale).set(155, offset);
    if (minor < 4 || format < 6) bytes.set(107, n);
    if (minor == 4) bytes.set(247, std::uint64_t{n});
    return bytes.text(std::string(gap, '#'));
  }
  Bytes file() const {
    Bytes bytes = header();
    for (std::size_t i = 0; i < points.size(); ++i) {
      Bytes record(std::string(record_bytes(), '\x5a'));
      record.set(0, points[i]);
      if (kRgbOffset[format] > 0) record.set(kRgbOffset[format], colors[i]);
      bytes.text(record.str());
    }
    return bytes;
  }
};

TEST(LasReader, EveryVersionAndPointFormat) {
  for (U8 minor = 0; minor <= 4; ++minor) {
    for (U8 format = 0; format <= 10; ++format) {
      const Las las{.minor = minor, .format = format, .extra = static_cast<U16>(format % 3), .gap = 60};
      const auto file = read_content("a.las", las.file().str());
      EXPECT_EQ(file.info.format, "LAS 1." + std::to_string(minor) + " format " + std::to_string(format));
      EXPECT_LT((point(file, 0) - Eigen::Vector3d(500000.01, 4000000.02, 0.003)).norm(), 1e-8);
      if (kRgbOffset[format] > 0) {
        EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb16>{{256, 512, 65535}}));
      } else {
        EXPECT_FALSE(file.cloud.has_color());
      }
    }
  }
}

TEST(LasReader, EqualsTheDoublePlyOfItsCoordinates) {
  Las las{.format = 2, .points = {}, .colors = {}};
  Bytes ply(
      "ply\nformat binary_little_endian 1.0\nelement vertex 20000\nproperty double x\nproperty double y\n"
      "property double z\nproperty ushort red\nproperty ushort green\nproperty ushort blue\nend_header\n");
  std::uint32_t state = 1;
  const auto random = [&] { return state = state * 1664525U + 1013904223U; };
  for (int i = 0; i < 20000; ++i) {
    las.points.push_back({});
    las.colors.push_back({});
    for (std::size_t k = 0; k < 3; ++k) {
      las.points.back()[k] = static_cast<std::int32_t>(random() >> 10) - (1 << 21);
      ply.put(las.points.back()[k] * las.scale[k] + las.offset[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) ply.put(las.colors.back()[k] = static_cast<U16>(random() >> 16));
  }
  const auto from_las = read_content("a.las", las.file().str());
  EXPECT_NE(from_las.cloud.origin, Eigen::Vector3d::Zero());
  expect_same_cloud(from_las.cloud, read_content("a.ply", ply.str()).cloud);
}

TEST(LasReader, EightBitColorsInSixteenBitFields) {
  Las las{.points = {{1, 2, 3}, {4, 5, 6}}, .colors = {{0, 128, 255}, {1, 2, 3}}};
  auto file = read_content("a.las", las.file().str());
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{0, 128, 255}, {1, 2, 3}}));
  EXPECT_THAT(all_notes(file), HasSubstr("8-bit colors in 16-bit fields"));
  las.colors[1][1] = 256;
  file = read_content("a.las", las.file().str());
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb16>{{0, 128, 255}, {1, 256, 3}}));
  EXPECT_TRUE(file.info.notes.empty());
  las.colors = {{0, 0, 0}, {0, 0, 0}};
  EXPECT_FALSE(read_content("a.las", las.file().str()).cloud.has_color());
}

TEST(LasReader, RefusesLazWithTheCommandThatConvertsIt) {
  const std::string laz = Las{}.file().set(104, static_cast<U8>(0x83)).str();
  EXPECT_THAT(refusal("map.laz", laz), ::testing::AllOf(HasSubstr("laszip -i"), HasSubstr("map.las")));
  // A writer that leaves the bit out still has its record.
  Las las{.gap = 54};
  Bytes bytes = las.file();
  bytes.set(100, 1U).set(227 + 2, std::array{'l', 'a', 's', 'z', 'i', 'p', ' ', 'e', 'n', 'c', 'o', 'd', 'e', 'd'});
  EXPECT_THAT(refusal("map.las", bytes.str()), HasSubstr("laszip -i"));
}

TEST(LasReader, BadHeaders) {
  const Las las;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<std::string, std::string> kCases[] = {
      {las.file().str().substr(0, 226), "truncated: the LAS header"},
      {Las{.minor = 4}.file().str().substr(0, 300), "truncated: the LAS 1.4 header"},
      {las.file().set(24, U8{2}).str(), "LAS version 2.2"},
      {las.file().set(25, U8{5}).str(), "LAS version 1.5"},
      {las.file().set(104, U8{11}).str(), "point format 11"},
      {las.file().set(105, U16{33}).str(), "records of 33 bytes, but point format 3 takes 34"},
      {las.file().set(131, 0.0).str(), "x scale factor 0"},
      {las.file().set(139, nan).str(), "y scale factor nan"},
      {las.file().set(171, std::numeric_limits<double>::infinity()).str(), "z offset inf"},
      {las.file().set(96, 100U).str(), "points from byte 100 on, inside the header"},
      {las.file().set(96, 4000000000U).str(), "truncated: all that comes before the points"},
      {las.file().set(107, 2U).str(), "truncated: 2 points of 34 bytes from byte 227 on do not fit into 261 bytes"},
      {las.file().set(107, 4294967295U).str(), "truncated: 4294967295 points"},
      {las.file().set(107, 0U).str(), "holds no points"},
      {Las{.minor = 4}.file().set(247, ~std::uint64_t{0}).str(), "truncated: 18446744073709551615 points"},
      {las.file().set(155, 1e300).str(), "none of its 1 points is finite; 1 left out: no return"},
      {las.file().set(131, 1e308).set(155, 1e308).str(), "none of its 1 points is finite"},
  };
  for (const auto& [content, message] : kCases) EXPECT_THAT(refusal("bad.las", content), HasSubstr(message));
}

TEST(LasReader, TruncatedAnywhereIsRefused) {
  const std::string bytes = Las{.gap = 3}.file().str();
  for (std::size_t size = 4; size < bytes.size(); ++size) {
    EXPECT_THAT(refusal("t.las", bytes.substr(0, size)), HasSubstr("truncated")) << size;
  }
}

}  // namespace
}  // namespace cmap::testing
