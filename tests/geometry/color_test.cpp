#include "cmap/geometry/color.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace cmap {
namespace color_test {

using Eigen::Vector3d;

struct LabPair {
  Vector3d lab1, lab2;
  double delta_e;
};

/// Table 1 of Sharma, Wu, Dalal 2005: 34 pairs that visit every branch of the formula.
std::vector<LabPair> sharma_pairs() {
  const char* source = std::getenv("CMAP_SOURCE_DIR");
  std::ifstream file(std::string(source == nullptr ? "." : source) + "/tests/oracle/sharma2005.txt");
  std::vector<LabPair> pairs;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream fields(line);
    LabPair p;
    fields >> p.lab1[0] >> p.lab1[1] >> p.lab1[2] >> p.lab2[0] >> p.lab2[1] >> p.lab2[2] >> p.delta_e;
    if (fields.fail()) throw std::runtime_error("tests/oracle/sharma2005.txt: seven numbers expected: " + line);
    pairs.push_back(p);
  }
  if (pairs.size() != 34)
    throw std::runtime_error("tests/oracle/sharma2005.txt: 34 pairs expected; is CMAP_SOURCE_DIR set?");
  return pairs;
}

void expect_near(const Vector3d& actual, const Vector3d& expected, double tolerance) {
  // Written so that NaN fails.
  EXPECT_TRUE(((actual - expected).array().abs() <= tolerance).all())
      << "actual " << actual.transpose() << ", expected " << expected.transpose();
}

TEST(DeltaE2000, EqualsThePublishedTable) {
  for (const LabPair& p : sharma_pairs()) {
    // The table has four decimals.
    EXPECT_NEAR(delta_e_2000(p.lab1, p.lab2), p.delta_e, 5e-5) << p.lab1.transpose() << " | " << p.lab2.transpose();
  }
}

TEST(DeltaE2000, IsSymmetric) {
  for (const LabPair& p : sharma_pairs()) {
    // A few roundings of doubles; a hue on the wrong side of the jump at 180 degrees costs 0.04 and more.
    EXPECT_NEAR(delta_e_2000(p.lab1, p.lab2), delta_e_2000(p.lab2, p.lab1), 1e-12)
        << p.lab1.transpose() << " | " << p.lab2.transpose();
  }
}

TEST(DeltaE2000, OppositeHuesCountAsNotAbove180Degrees) {
  // The formula jumps at 180 degrees; rounding must not choose the side, as pairs 10 and 14 of the table have it. So
  // nothing may happen where lab2 turns by 1e-9 to an angle below 180 degrees: that moves it by 3e-8 at most.
  for (int a = -40; a <= 40; ++a) {
    for (int b = 1; b <= 40; ++b) {
      const Vector3d lab1(50.0, 0.3 * a, 0.7 * b), lab2(60.0, -lab1.y(), -lab1.z());
      const Vector3d turned(60.0, lab2.y() + 1e-9 * lab2.z(), lab2.z() - 1e-9 * lab2.y());
      ASSERT_NEAR(delta_e_2000(lab1, lab2), delta_e_2000(lab1, turned), 1e-7) << lab1.transpose();
      ASSERT_NEAR(delta_e_2000(lab2, lab1), delta_e_2000(turned, lab1), 1e-7) << lab1.transpose();
    }
  }
}

TEST(DeltaE2000, OfAColorToItselfIsZero) {
  for (const LabPair& p : sharma_pairs()) {
    EXPECT_EQ(delta_e_2000(p.lab1, p.lab1), 0.0);
    EXPECT_EQ(delta_e_2000(p.lab2, p.lab2), 0.0);
  }
}

TEST(DeltaE2000, OfBlackAndWhiteIs100) {
  EXPECT_DOUBLE_EQ(delta_e_2000({0, 0, 0}, {100, 0, 0}), 100.0);  // S_L is 1 at the mean lightness of 50
}

TEST(SrgbToLab, EqualsPublishedD65Values) {
  // Published to four decimals, as brucelindbloom.com's calculator gives them (D65, no adaptation).
  constexpr double kLastDigit = 5e-5;
  expect_near(srgb_to_lab({1, 1, 1}), {100, 0, 0}, kLastDigit);
  expect_near(srgb_to_lab({1, 0, 0}), {53.2408, 80.0925, 67.2032}, kLastDigit);
  expect_near(srgb_to_lab({0, 1, 0}), {87.7347, -86.1827, 83.1793}, kLastDigit);
  expect_near(srgb_to_lab({0, 0, 1}), {32.2970, 79.1875, -107.8602}, kLastDigit);
}

TEST(SrgbToLab, BlackIsZero) {
  expect_near(srgb_to_lab({0, 0, 0}), {0, 0, 0}, 1e-13);  // 4/29 * 116 - 16 is not exactly 0 in doubles
}

TEST(SrgbToLab, GraysHaveNoChromaAndFollowTheCurve) {
  // By hand: the straight parts of both curves, (10/255 / 12.92) * 24389/27, and their powers, 116 * cbrt(((0.5 +
  // 0.055) / 1.055)^2.4) - 16. The rows of the published matrix add up to white only to seven digits: 1e-4.
  expect_near(srgb_to_lab(Vector3d::Constant(10.0 / 255.0)), {2.741748, 0, 0}, 1e-4);
  expect_near(srgb_to_lab(Vector3d::Constant(0.5)), {53.388965, 0, 0}, 1e-4);
}

TEST(RgbToYcbcr709, EqualsHandValues) {
  // The standard's matrix rounded to four decimals, as pc_error has it; the rest is a few roundings of doubles.
  constexpr double kRounding = 1e-15;
  expect_near(rgb_to_ycbcr709({0, 0, 0}), {0, 0, 0}, 0.0);
  expect_near(rgb_to_ycbcr709({1, 1, 1}), {1, 0, 0}, kRounding);
  expect_near(rgb_to_ycbcr709({1, 0, 0}), {0.2126, -0.1146, 0.5}, kRounding);
  expect_near(rgb_to_ycbcr709({0, 1, 0}), {0.7152, -0.3854, -0.4542}, kRounding);
  expect_near(rgb_to_ycbcr709({0, 0, 1}), {0.0722, 0.5, -0.0458}, kRounding);
  expect_near(rgb_to_ycbcr709({0.5, 0.25, 0.75}), {0.33925, 0.22135, 0.1021}, kRounding);
}

TEST(RgbToYcbcr709, IsTheStandardToFourDecimals) {
  // BT.709: Y = 0.2126 R + 0.7152 G + 0.0722 B, Cb = (B - Y) / 1.8556, Cr = (R - Y) / 1.5748. Each of three
  // coefficients is off by at most 5e-5.
  for (const Vector3d& rgb : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(0.9, 0.3, 0.6)}) {
    const double y = 0.2126 * rgb.x() + 0.7152 * rgb.y() + 0.0722 * rgb.z();
    expect_near(rgb_to_ycbcr709(rgb), {y, (rgb.z() - y) / 1.8556, (rgb.x() - y) / 1.5748}, 1.5e-4);
  }
}

TEST(ToRgb8, RoundsAndStaysWithinTheRange) {
  EXPECT_EQ(to_rgb8({0.49f, 0.5f, 254.5f}), (Rgb8{0, 1, 255}));
  EXPECT_EQ(to_rgb8({-3.0f, 300.0f, 17.0f}), (Rgb8{0, 255, 17}));
  EXPECT_EQ(to_rgb8({NAN, 1.0f, NAN}), (Rgb8{0, 1, 0})) << "no color";
}

TEST(Rgb255, EightBitIsExact) {
  const Colors colors = Array<Rgb8>{{0, 1, 2}, {127, 254, 255}};
  EXPECT_EQ(rgb_255(colors, 0), (RgbF{0.0f, 1.0f, 2.0f}));
  EXPECT_EQ(rgb_255(colors, 1), (RgbF{127.0f, 254.0f, 255.0f}));
}

TEST(Rgb255, SixteenBitIsDividedBy257) {
  Array<Rgb16> colors;
  for (int v = 0; v < 256; ++v) {
    const auto wide = static_cast<std::uint16_t>(v * 257);  // an 8-bit value, widened
    colors.push_back({wide, 0, static_cast<std::uint16_t>(65535 - wide)});
  }
  colors.push_back({1, 0, 0});
  for (std::size_t v = 0; v < 256; ++v) {
    EXPECT_EQ(rgb_255(colors, v), (RgbF{static_cast<float>(v), 0.0f, static_cast<float>(255 - v)}));
  }
  EXPECT_EQ(rgb_255(colors, 256)[0], 1.0f / 257.0f);
}

TEST(Rgb255, FloatIsMultipliedBy255) {
  const Colors colors = Array<RgbF>{{0.0f, 0.5f, 1.0f}, {0.25f, 0.125f, 0.75f}};
  EXPECT_EQ(rgb_255(colors, 0), (RgbF{0.0f, 127.5f, 255.0f}));
  EXPECT_EQ(rgb_255(colors, 1), (RgbF{63.75f, 31.875f, 191.25f}));
}

TEST(Rgb255, WithoutColorsIsRefused) { EXPECT_THROW(rgb_255(Colors{}, 0), std::invalid_argument); }

}  // namespace color_test
}  // namespace cmap
