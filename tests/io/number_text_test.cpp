#include "cmap/io/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bytes/decimal_comma.hpp"

namespace cmap {
namespace number_text_test {

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

TEST(NumberText, ReadsWhatIsNoNumberAsEachRuntimeWritesIt) {
  for (const char* text : {"nan", "NaN", "-nan", "nan(ind)", "-nan(ind)", "-nan(snan)", "NAN", "1.#QNAN", "-1.#IND",
                           "1.#QNAN0", "-1.#IND00", "1.#SNAN", "1.#R", "-1.#IO", "+1.#QNAN"}) {
    double value = 0.0;
    EXPECT_TRUE(parse_number(text, value) && std::isnan(value)) << text;
    float single = 0.0F;
    EXPECT_TRUE(parse_number(text, single) && std::isnan(single)) << text;
  }
  for (const char* text : {"1.#INF", "1.#INF00", "+1.#INF", "inf", "Infinity", "INF"}) {
    double value = 0.0;
    EXPECT_TRUE(parse_number(text, value) && value == kInfinity) << text;
  }
  double value = 0.0;
  EXPECT_TRUE(parse_number("-1.#INF", value) && value == -kInfinity);
  for (const char* text : {"1.#", "1.#inf", "2.#INF", "1#INF", "1.#0", "1.#QNAN;", "11.#INF", "--1.#IND", "#NUM!"}) {
    EXPECT_FALSE(parse_number(text, value)) << text;
  }
}

TEST(NumberText, CommentsBeginAtTheFirstSignOutsideANumber) {
  EXPECT_EQ(without_comment("1 2 # three"), "1 2 ");
  EXPECT_EQ(without_comment("# all"), "");
  EXPECT_EQ(without_comment("1.#QNAN -1.#IND # lost # twice"), "1.#QNAN -1.#IND ");
  EXPECT_EQ(without_comment("2 1.# one"), "2 1.");
  EXPECT_EQ(without_comment("1 2"), "1 2");
}

TEST(NumberText, DecimalCommasAreKnownByWhatElseSeparates) {
  for (const char* line : {"1,5 2,5", "1,5;2", "1 2,5 3", "1,5\t2,5", "1; 2,25", "-1,5  0,25 1"}) {
    EXPECT_TRUE(has_decimal_commas(line)) << line;
  }
  for (const char* line : {"1,5", "1, 5", "1 ,5", "1,2,3", "1,0,0;0,1,0", "[1,0,0,0; 0,1,0,0]", "1.5 2", "1.0, 2.0 3.0",
                           "a,b c", "", "x, y"}) {
    EXPECT_FALSE(has_decimal_commas(line)) << line;
  }
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

}  // namespace number_text_test
}  // namespace cmap
