#include <limits>

#include "io/las_testing.hpp"

namespace cmap::testing {
namespace las_reader_test {

using ::testing::HasSubstr;

TEST(LasReader, EveryVersionAndPointFormat) {
  for (U8 minor = 0; minor <= 5; ++minor) {
    for (U8 format = 0; format <= 10; ++format) {
      const Las las{.minor = minor, .format = format, .extra = static_cast<U16>(format % 3), .gap = 60};
      const auto file = read_content("a.las", las.file().str());
      EXPECT_EQ(file.info.format, "LAS 1." + std::to_string(minor) + " format " + std::to_string(format));
      EXPECT_LT((point(file, 0) - Eigen::Vector3d(500000.01, 4000000.02, 0.003)).norm(), 1e-8);
      if (Las::kRgbOffset[format] > 0) {
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

TEST(LasReader, TheFilesStepIsItsCoarsestScale) {
  EXPECT_EQ(read_content("a.las", Las{.scale = {0.001, 0.01, 0.0001}}.file().str()).cloud.file_step_m, 0.01);
  EXPECT_EQ(read_content("a.las", Las{.scale = {0.001, -0.25, 0.001}}.file().str()).cloud.file_step_m, 0.25);
  const Las feet{.scale = {0.01, 0.01, 0.01}, .records = {geo_keys_record({{3076, 0, 1, 9002}, {4099, 0, 1, 9002}})}};
  EXPECT_NEAR(read_content("a.las", feet.file().str()).cloud.file_step_m, 0.003048, 1e-15);
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
  const Las las{.records = {{"other", 1, "any"}, {"laszip encoded", 22204, std::string(52, '\1')}}};
  EXPECT_THAT(refusal("map.las", las.file().str()), HasSubstr("laszip -i"));
}

TEST(LasReader, BadHeaders) {
  const Las las;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<std::string, std::string> kCases[] = {
      {las.file().str().substr(0, 226), "truncated: the LAS header"},
      {Las{.minor = 4}.file().str().substr(0, 300), "truncated: the LAS 1.4 header"},
      {las.file().set(24, U8{2}).str(), "LAS version 2.2"},
      {las.file().set(25, U8{6}).str(), "LAS version 1.6; 1.0 to 1.5 expected"},
      {las.file().set(104, U8{11}).str(), "point format 11"},
      {las.file().set(105, U16{33}).str(), "records of 33 bytes, but point format 3 takes 34"},
      {las.file().set(131, 0.0).str(), "x scale factor 0"},
      {las.file().set(139, nan).str(), "y scale factor nan"},
      {las.file().set(171, std::numeric_limits<double>::infinity()).str(), "z offset inf"},
      {las.file().set(96, 100U).str(), "points from byte 100 on, inside the header"},
      {las.file().set(96, 4000000000U).str(), "truncated: all that comes before the points"},
      {las.file().set(107, 2U).str(), "truncated: 2 points of 34 bytes from byte 227 on do not fit into 261 bytes"},
      {las.file().set(107, 4294967295U).str(), "truncated: 4294967295 points"},
      {las.file().set(107, 0U).str().substr(0, 227), "holds no points"},
      {Las{.minor = 4}.file().set(247, ~std::uint64_t{0}).str(), "truncated: 18446744073709551615 points"},
      {las.file().set(155, 1e300).str(), "none of its 1 points is left; 1 left out: no return"},
      {las.file().set(131, 1e308).set(155, 1e308).str(), "none of its 1 points is finite"},
  };
  for (const auto& [content, message] : kCases) EXPECT_THAT(refusal("bad.las", content), HasSubstr(message));
}

TEST(LasReader, ACountOfZeroBeforePointsIsAnUnfinishedFile) {
  Las las{.points = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  EXPECT_THAT(refusal("a.las", las.file().set(107, 0U).str()),
              HasSubstr("the header counts 0 points, but 102 bytes follow, room for 3 points: the file was not"));
  las = {.minor = 4, .format = 7};
  EXPECT_THAT(refusal("a.las", las.file().set(247, std::uint64_t{0}).str()), HasSubstr("room for 1 points"));
  las.points.clear();
  las.extended_records = {{"other", 1, std::string(100, '#')}};
  EXPECT_THAT(refusal("a.las", las.file().str()), HasSubstr("holds no points")) << "records are no points";
}

TEST(LasReader, PointsBeyondTheCountAreSaid) {
  const Las las{.points = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  const auto file = read_content("a.las", las.file().set(107, 2U).str());
  EXPECT_EQ(file.info.points, 2U);
  EXPECT_THAT(all_warnings(file), HasSubstr("bytes_left: 34 bytes behind the points are not read, room for 1 more "
                                            "points than the header's 2"));
}

TEST(LasReader, BytesLeftOverAreSaid) {
  const Las las{.points = {{1, 2, 3}, {4, 5, 6}}};
  EXPECT_THAT(all_warnings(read_content("a.las", las.file().text("abc").str())),
              HasSubstr("bytes_left: 3 bytes behind the points are not read"));
  EXPECT_THAT(all_warnings(read_content("a.las", las.file().str())), "");
}

TEST(LasReader, RecordsLongerThanTheHeaderSaysAreRefused) {
  const Las las{.extra = 2, .points = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  EXPECT_THAT(all_warnings(read_content("a.las", las.file().str())), "") << "extra bytes that the header knows of";
  EXPECT_THAT(refusal("a.las", las.file().set(105, U16{34}).str()),
              HasSubstr("6 bytes are left behind the points, 2 a point: records seem to be longer"));
}

TEST(LasReader, TwoCountsThatDisagree) {
  const Las las{.minor = 4, .points = {{1, 2, 3}, {4, 5, 6}}};
  EXPECT_THAT(all_warnings(read_content("a.las", las.file().set(107, 5U).str())),
              HasSubstr("two_counts: the header counts 2 points in its 64-bit field, 5 in its old 32-bit field"));
  const auto old = read_content("a.las", las.file().set(247, std::uint64_t{0}).str());
  EXPECT_EQ(old.info.points, 2U) << "the old field alone counts";
  EXPECT_THAT(all_warnings(old), "");
}

TEST(LasReader, WaveformsBehindThePointsOfLas13) {
  Las las{.minor = 3, .format = 4};
  const std::string waveforms = LasRecord{"LASF_Spec", 65535, std::string(500, '\x7f')}.bytes(true);
  const auto place = std::uint64_t{las.data_offset() + las.record_bytes()};
  las.global_encoding = 2;
  EXPECT_THAT(all_warnings(read_content("a.las", las.file().set(227, place).text(waveforms).str())), "");
  las.global_encoding = 0;
  EXPECT_THAT(all_warnings(read_content("a.las", las.file().text(waveforms).str())), HasSubstr("bytes_left: 560"));
}

TEST(LasReader, TruncatedAnywhereIsRefused) {
  const std::string bytes = Las{.gap = 3}.file().str();
  for (std::size_t size = 4; size < bytes.size(); ++size) {
    EXPECT_THAT(refusal("t.las", bytes.substr(0, size)), HasSubstr("truncated")) << size;
  }
}

}  // namespace las_reader_test
}  // namespace cmap::testing
