// What color numbers mean: one rule for every format, held here to colors whose values are known.
#include <fmt/format.h>

#include "cmap/geometry/color.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace color_scale_test {

using ::testing::HasSubstr;

/// Colors of a 16-color test card: in 0..255 whole, never gray, never one above the other.
std::vector<std::array<int, 3>> card() {
  std::vector<std::array<int, 3>> colors;
  for (int i = 0; i < 64; ++i) colors.push_back({(i * 37) % 256, 255 - (i * 91) % 256, (i * 53 + 11) % 256});
  colors.push_back({255, 0, 128});
  return colors;
}

/// A PLY of these numbers, as the type of the name.
template <class T>
std::string ply_of(std::string_view type, const std::vector<std::array<T, 3>>& colors) {
  const std::string property = "property " + std::string(type) + " ";
  Bytes bytes("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(colors.size()) +
              "\nproperty float x\nproperty float y\nproperty float z\n" + property + "red\n" + property + "green\n" +
              property + "blue\nend_header\n");
  for (std::size_t i = 0; i < colors.size(); ++i) {
    bytes.put(static_cast<float>(i), 1.0F, 2.0F, colors[i][0], colors[i][1], colors[i][2]);
  }
  return bytes.str();
}

template <class T, class Map>
std::vector<std::array<T, 3>> mapped(Map&& map) {
  std::vector<std::array<T, 3>> colors;
  for (const auto& c : card()) {
    colors.push_back({static_cast<T>(map(c[0])), static_cast<T>(map(c[1])), static_cast<T>(map(c[2]))});
  }
  return colors;
}

template <class T>
std::string text_of(const std::vector<std::array<T, 3>>& colors) {
  std::string text = "x y z red green blue\n";
  for (std::size_t i = 0; i < colors.size(); ++i) {
    text += fmt::format("{} 1 2 {} {} {}\n", i, colors[i][0], colors[i][1], colors[i][2]);
  }
  return text;
}

std::string all_warnings(const PointCloudFile& file) {
  std::string text;
  for (const Warning& warning : file.info.warnings) text += warning.id + ": " + warning.message + "\n";
  return text;
}

void expect_card(const PointCloudFile& file, double tolerance, std::string_view what) {
  const auto wanted = card();
  ASSERT_EQ(file.cloud.size(), wanted.size()) << what;
  ASSERT_TRUE(file.cloud.has_color()) << what;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const RgbF color = rgb_255(file.cloud.colors, i);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(color[k], wanted[i][k], tolerance) << what << ", point " << i;
  }
  EXPECT_TRUE(file.info.warnings.empty()) << what << ": " << all_warnings(file);
  EXPECT_FALSE(file.info.gray_colors) << what;
}

// Division by 255 and multiplication with it again round twice in float: 2^-23 of 255.
constexpr double kFloatRounding = 4e-5;

TEST(ColorScale, EveryTypeAndScaleOfOneCard) {
  const auto same = [](int v) { return v; };
  expect_card(read_content("a.ply", ply_of("uchar", mapped<U8>(same))), 0.0, "uchar");
  expect_card(read_content("a.ply", ply_of("ushort", mapped<U16>(same))), 0.0, "8 bit in ushort");
  expect_card(read_content("a.ply", ply_of("ushort", mapped<U16>([](int v) { return 257 * v; }))), 0.0, "x 257");
  const auto times_256 = read_content("a.ply", ply_of("ushort", mapped<U16>([](int v) { return 256 * v; })));
  expect_card(times_256, 0.0, "x 256");
  EXPECT_EQ(times_256.info.notes.size(), 1U) << "said once";
  expect_card(read_content("a.ply", ply_of("short", mapped<std::int16_t>(same))), 0.0, "short");
  expect_card(read_content("a.ply", ply_of("int", mapped<std::int32_t>(same))), 0.0, "int");
  expect_card(read_content("a.ply", ply_of("uint", mapped<std::uint32_t>([](int v) { return 257 * v; }))), 0.0,
              "uint x 257");
  expect_card(read_content("a.ply", ply_of("uint", mapped<std::uint32_t>([](int v) { return 256 * v; }))), 0.0,
              "uint x 256");
  expect_card(read_content("a.ply", ply_of("int64", mapped<std::int64_t>(same))), 0.0, "int64");
  expect_card(read_content("a.ply", ply_of("float", mapped<float>(same))), 0.0, "float 0 to 255");
  expect_card(read_content("a.ply", ply_of("double", mapped<double>(same))), 0.0, "double 0 to 255");
  expect_card(read_content("a.ply", ply_of("float", mapped<float>([](int v) { return 257 * v; }))), 0.0, "float x 257");
  expect_card(read_content("a.ply", ply_of("float", mapped<float>([](int v) { return 256 * v; }))), 0.0, "float x 256");
  const auto unit = [](int v) { return static_cast<double>(v) / 255.0; };
  expect_card(read_content("a.ply", ply_of("float", mapped<float>(unit))), kFloatRounding, "float 0 to 1");
  expect_card(read_content("a.ply", ply_of("double", mapped<double>(unit))), kFloatRounding, "double 0 to 1");
  expect_card(read_content("a.txt", text_of(mapped<int>(same))), 0.0, "text");
  expect_card(read_content("a.txt", text_of(mapped<double>(unit))), kFloatRounding, "text 0 to 1");
  expect_card(read_content("a.txt", text_of(mapped<int>([](int v) { return 257 * v; }))), 0.0, "text x 257");
}

TEST(ColorScale, FractionsOf255) {
  // As a mean of several views leaves them: a quarter below the card.
  const auto quarter = [](int v) { return std::max(0.0, v - 0.25); };
  for (const auto& file : {read_content("a.ply", ply_of("float", mapped<float>(quarter))),
                           read_content("a.txt", text_of(mapped<double>(quarter)))}) {
    EXPECT_EQ(file.info.color_scale, "0 to 255, with fractions");
    for (std::size_t i = 0; i < card().size(); ++i) {
      EXPECT_NEAR(rgb_255(file.cloud.colors, i)[1], quarter(card()[i][1]), kFloatRounding);
    }
  }
}

TEST(ColorScale, TheWholeFileDecidesNotItsStart) {
  // 5000 points of [0,1] at most, then one of 200: more than one piece, of 2048 points, on the way.
  std::vector<std::array<float, 3>> colors(5000, {0.5F, 1.0F, 0.0F});
  colors.push_back({200.0F, 100.5F, 0.0F});
  const auto file = read_content("a.ply", ply_of("float", colors));
  EXPECT_NEAR(rgb_255(file.cloud.colors, 5000)[0], 200.0, kFloatRounding);
  EXPECT_NEAR(rgb_255(file.cloud.colors, 0)[0], 0.5, kFloatRounding);
  EXPECT_THAT(all_warnings(file), HasSubstr("another scale"));
  // The same in whole numbers: bytes first, 16 bits later.
  std::vector<std::array<U16, 3>> shorts(5000, {10, 20, 30});
  shorts.push_back({65535, 0, 0});
  const auto wide = read_content("a.ply", ply_of("ushort", shorts));
  EXPECT_FLOAT_EQ(rgb_255(wide.cloud.colors, 5000)[0], 255.0F);
  EXPECT_FLOAT_EQ(rgb_255(wide.cloud.colors, 0)[2], 30.0F / 257.0F);
  EXPECT_THAT(all_warnings(wide), HasSubstr("another scale"));
}

TEST(ColorScale, RoundingJustOutsideIsCutSilentlyAndMoreIsCounted) {
  const auto nearly = read_content("a.ply", ply_of<float>("float", {{-1e-6F, 0.5F, 1.000001F}, {0.1F, 0.2F, 0.3F}}));
  EXPECT_EQ(rgb_255(nearly.cloud.colors, 0), (RgbF{0.0F, 127.5F, 255.0F}));
  EXPECT_TRUE(nearly.info.warnings.empty()) << all_warnings(nearly);
  const auto bicubic = read_content("a.ply", ply_of<float>("float", {{-0.6F, 12.25F, 268.0F}, {10.0F, 20.0F, 200.0F}}));
  EXPECT_EQ(rgb_255(bicubic.cloud.colors, 0)[2], 255.0F);
  EXPECT_EQ(rgb_255(bicubic.cloud.colors, 0)[0], 0.0F);
  EXPECT_THAT(all_warnings(bicubic), HasSubstr("1 of 2 colors leave the range of 0 to 255"));
  const auto bright = read_content("a.ply", ply_of<float>("float", {{0.2F, 0.5F, 1.3F}}));
  EXPECT_EQ(rgb_255(bright.cloud.colors, 0)[2], 255.0F);
  EXPECT_THAT(all_warnings(bright), HasSubstr("1 of 1 colors leave the range of 0 to 1"));
}

TEST(ColorScale, NumbersThatAreNoColorsAreRefused) {
  EXPECT_THAT(refusal("a.ply", ply_of<float>("float", {{1, 2, 3}, {0, 70000, 0}})),
              HasSubstr("point 2: green = 70000"));
  EXPECT_THAT(refusal("a.ply", ply_of<float>("float", {{1, 2, 3}, {0, 0, -30}})), HasSubstr("point 2: blue = -30"));
  EXPECT_THAT(refusal("a.ply", ply_of<std::int32_t>("int", {{-1, 2, 200}})), HasSubstr("point 1: red = -1"));
  EXPECT_THAT(refusal("a.ply", ply_of<std::int8_t>("char", {{100, 2, 3}, {-1, 0, 0}})),
              ::testing::AllOf(HasSubstr("point 2: red = -1"), HasSubstr("uchar")));
}

TEST(ColorScale, SignedBytesAndMixedTypesAreTheirNumbers) {
  const auto file = read_content("a.ply", ply_of<std::int8_t>("char", {{64, 127, 0}}));
  EXPECT_EQ(file.cloud.colors, Colors(Array<Rgb8>{{64, 127, 0}}));
}

TEST(ColorScale, AllBlackIsNoColorInEveryFormat) {
  const std::string black_text = "1 2 3 0 0 0\n4 5 6 0 0 0\n";
  for (const auto& file : {read_content("a.ply", ply_of<U8>("uchar", {{0, 0, 0}, {0, 0, 0}})),
                           read_content("a.ply", ply_of<float>("float", {{0, 0, 0}})),
                           read_content("a.ply", ply_of<U16>("ushort", {{0, 0, 0}})),
                           read_content("a.txt", "x y z r g b\n" + black_text)}) {
    EXPECT_FALSE(file.cloud.has_color());
    EXPECT_THAT(all_warnings(file), HasSubstr("black"));
    EXPECT_EQ(file.info.color_scale, "");
  }
}

TEST(ColorScale, NaNIsAPointWithoutColor) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const auto file =
      read_content("a.ply", ply_of<float>("float", {{0.5F, nan, 0.5F}, {0.25F, 0.5F, 1.0F}, {inf, 0.0F, 0.0F}}));
  ASSERT_EQ(file.cloud.size(), 3U);
  EXPECT_TRUE(std::isnan(rgb_255(file.cloud.colors, 0)[0]) && std::isnan(rgb_255(file.cloud.colors, 0)[2]));
  EXPECT_FLOAT_EQ(rgb_255(file.cloud.colors, 1)[1], 127.5F);
  EXPECT_TRUE(std::isnan(rgb_255(file.cloud.colors, 2)[1]));
  EXPECT_THAT(all_warnings(file), HasSubstr("2 of 3 points have no color"));
  const auto none = read_content("a.ply", ply_of<float>("float", {{nan, nan, nan}}));
  EXPECT_FALSE(none.cloud.has_color());
  EXPECT_THAT(all_warnings(none), HasSubstr("no color"));
}

TEST(ColorScale, DarkColorsAreSaid) {
  const auto twelve_bit = [](int v) { return 16 * v; };
  EXPECT_THAT(
      all_warnings(read_content("a.ply", ply_of("ushort", mapped<U16>([&](int v) { return twelve_bit(v) + 5; })))),
      HasSubstr("of 65535"));
  EXPECT_THAT(all_warnings(read_content("a.ply", ply_of<U8>("uchar", {{0, 1, 1}, {1, 0, 1}}))), HasSubstr("1 of 255"));
  EXPECT_THAT(all_warnings(read_content("a.ply", ply_of<float>("float", {{0.003F, 0.001F, 0.002F}}))),
              HasSubstr("0.003 of 1"));
}

TEST(ColorScale, TwoScalesInOneFileAreSaid) {
  const auto merged = [](auto low, const auto& high, std::size_t n_low) {
    low.resize(n_low);
    low.insert(low.end(), high.begin(), high.end());
    return low;
  };
  // 40 of 105 colors of tiles that kept 8 bits: the test card has no other brightest channel below 256 of 65535.
  const auto sixteen = mapped<U16>([](int v) { return 257 * v; });
  const auto file = read_content("a.ply", ply_of("ushort", merged(mapped<U16>([](int v) { return v; }), sixteen, 40)));
  EXPECT_THAT(all_warnings(file), ::testing::AllOf(HasSubstr("38.1 %"), HasSubstr("at most 255")));
  const auto whole = mapped<float>([](int v) { return 0.99F * static_cast<float>(v) + 0.25F; });
  const auto floats = merged(mapped<float>([](int v) { return static_cast<float>(v) / 255.0F; }), whole, 40);
  EXPECT_THAT(all_warnings(read_content("a.ply", ply_of("float", floats))),
              ::testing::AllOf(HasSubstr("38.1 %"), HasSubstr("at most 1,")));
  // A dark scene goes on beyond 255: gray levels 0, 32, 64 ... of 65535 and one white point.
  std::vector<std::array<U16, 3>> dark;
  for (int i = 0; i < 100; ++i) dark.push_back({static_cast<U16>(32 * i), 0, 1});
  dark.push_back({65535, 0, 0});
  EXPECT_EQ(all_warnings(read_content("a.ply", ply_of("ushort", dark))), "");
}

TEST(ColorScale, EightBitsTimes128AreSaid) {
  EXPECT_THAT(all_warnings(read_content("a.ply", ply_of("ushort", mapped<U16>([](int v) { return 128 * v; })))),
              HasSubstr("8-bit colors times 128"));
  EXPECT_EQ(all_warnings(read_content("a.ply", ply_of("ushort", mapped<U16>([](int v) { return 128 * v + v % 2; })))),
            "");
}

TEST(ColorScale, OneColorForManyPointsIsSaid) {
  std::vector<std::array<U8, 3>> colors = mapped<U8>([](int v) { return v; });
  colors.insert(colors.end(), 40, {0, 0, 0});  // 40 of 105
  EXPECT_THAT(all_warnings(read_content("a.ply", ply_of("uchar", colors))),
              ::testing::AllOf(HasSubstr("40 of 105"), HasSubstr("black")));
  const std::vector<std::array<U8, 3>> gray(200, {192, 192, 192});
  const auto file = read_content("a.ply", ply_of("uchar", gray));
  EXPECT_THAT(all_warnings(file), ::testing::AllOf(HasSubstr("one and the same color"), HasSubstr("192 192 192")));
  EXPECT_TRUE(file.info.gray_colors);
}

}  // namespace color_scale_test
}  // namespace cmap::testing
