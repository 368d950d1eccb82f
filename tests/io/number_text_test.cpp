#include "io/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cmap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(NumberText, ReadsWhatPrintfWrites) {
  double value = 0.0;
  const std::pair<const char*, double> kCases[] = {{"1", 1},
                                                   {"-2.5", -2.5},
                                                   {"+3", 3},
                                                   {".5", 0.5},
                                                   {"5.", 5},
                                                   {"1e3", 1000},
                                                   {"1E-3", 0.001},
                                                   {"inf", kInfinity},
                                                   {"-Infinity", -kInfinity},
                                                   {"1e999", kInfinity},
                                                   {"-1e999", -kInfinity},
                                                   {"1e-999", 0.0}};
  for (const auto& [text, expected] : kCases) {
    EXPECT_TRUE(parse_number(text, value)) << text;
    EXPECT_EQ(value, expected) << text;
  }
  EXPECT_TRUE(parse_number("nan", value) && std::isnan(value));
  EXPECT_TRUE(parse_number("-nan", value) && std::isnan(value));
}

TEST(NumberText, RefusesEverythingElse) {
  double value = 0.0;
  for (const char* text : {"", "+", "-", ".", "e", "1,5", "1.2.3", "0x10", "--1", "+-1", "1e", "abc", "1 "}) {
    EXPECT_FALSE(parse_number(text, value)) << text;
  }
  unsigned long long whole = 0;
  for (const char* text : {"", "-1", "1.5", "18446744073709551616"}) EXPECT_FALSE(parse_number(text, whole)) << text;
}

TEST(NumberText, FloatIsTheNearestFloat) {
  float value = 0.0F;
  EXPECT_TRUE(parse_number("0.1", value));
  EXPECT_EQ(value, 0.1F);
  EXPECT_TRUE(parse_number("1e39", value));
  EXPECT_EQ(value, std::numeric_limits<float>::infinity());
  EXPECT_TRUE(parse_number("1e-60", value));
  EXPECT_EQ(value, 0.0F);
  EXPECT_TRUE(parse_number("0." + std::string(400, '0') + "1", value));
  EXPECT_EQ(value, 0.0F);
  EXPECT_TRUE(parse_number(std::string(400, '9') + ".5", value));
  EXPECT_EQ(value, std::numeric_limits<float>::infinity());
}

TEST(NumberText, CutsTokens) {
  std::string_view text = "  a\tbc \r";
  EXPECT_EQ(next_token(text), "a");
  EXPECT_EQ(next_token(text), "bc");
  EXPECT_EQ(next_token(text), "");
}

}  // namespace
}  // namespace cmap
