#include "clouds/unnamed_columns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace cmap {
namespace unnamed_columns_test {

using ::testing::HasSubstr;

/// Rows of x y z and what the caller puts behind them.
template <class Rest>
NumberTable table_of(std::size_t rows, Rest&& rest) {
  NumberTable table;
  for (std::size_t i = 0; i < rows; ++i) {
    std::vector<double> row{0.5 * static_cast<double>(i), 1.0, -2.0};
    for (const double v : rest(i)) row.push_back(v);
    table.columns = row.size();
    table.values.insert(table.values.end(), row.begin(), row.end());
  }
  return table;
}

using Values = std::vector<double>;

Values color(std::size_t i) {
  return {static_cast<double>(i * 37 % 256), static_cast<double>(i * 91 % 256), static_cast<double>(i * 53 % 256)};
}

/// Unit vectors around the compass, most of them with a negative part.
Values normal(std::size_t i) {
  const double a = static_cast<double>(i);
  return {0.6 * std::cos(a), 0.6 * std::sin(a), i % 2 == 0 ? 0.8 : -0.8};
}

Values joined(std::initializer_list<Values> parts) {
  Values all;
  for (const Values& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::optional<ColumnTriple> decide(const NumberTable& table, bool intensity_first = false) {
  FileInfo info;
  return find_unnamed_colors(table, intensity_first, info);
}

TEST(UnnamedColumns, EachLayoutInUse) {
  const auto at = [](std::size_t column) { return std::optional(ColumnTriple{column, column + 1, column + 2}); };
  const Values intensity{-1203.0}, alpha{255.0};
  EXPECT_EQ(decide(table_of(50, color)), at(3));
  EXPECT_EQ(decide(table_of(50, [&](std::size_t i) { return joined({color(i), alpha}); })), at(3));
  EXPECT_EQ(decide(table_of(50, [&](std::size_t i) { return joined({intensity, color(i)}); })), at(4));
  EXPECT_EQ(decide(table_of(50, [&](std::size_t i) { return joined({color(i), normal(i)}); })), at(3));
  EXPECT_EQ(decide(table_of(50, [&](std::size_t i) { return joined({normal(i), color(i)}); })), at(6));
  EXPECT_EQ(decide(table_of(50, [&](std::size_t i) { return joined({intensity, color(i), normal(i)}); })), at(4));
  EXPECT_EQ(decide(table_of(50, [&](std::size_t i) { return joined({normal(i), color(i), alpha}); })), at(6));
  EXPECT_EQ(decide(table_of(50, normal)), std::nullopt);
  EXPECT_EQ(decide(table_of(50, [](std::size_t) { return Values{0, 0, 0}; })), std::nullopt);
}

/// One more number before or after the color: told apart where it is of another kind or scale, else undecidable.
TEST(UnnamedColumns, OneNumberBesideTheColor) {
  const auto fraction = [](std::size_t i) { return Values{static_cast<double>(i % 17) / 17.0}; };
  const auto large = [](std::size_t i) { return Values{static_cast<double>(i * 83 % 4096)}; };
  const auto label = [](std::size_t i) { return Values{static_cast<double>(i % 5)}; };
  const auto decide_with = [](auto&& number, bool behind) {
    return decide(table_of(50, [&](std::size_t i) {
      return behind ? joined({color(i), number(i)}) : joined({number(i), color(i)});
    }));
  };
  for (const bool behind : {false, true}) {
    const auto expected = behind ? ColumnTriple{3, 4, 5} : ColumnTriple{4, 5, 6};
    EXPECT_EQ(decide_with(fraction, behind), expected);
    EXPECT_EQ(decide_with(large, behind), expected);
    EXPECT_EQ(decide_with(label, behind), std::nullopt);
  }
}

/// 255.08 is white and a rounding: that red stands before green and blue as much as an intensity would.
TEST(UnnamedColumns, OvershootsAreJudgedInEveryOrder) {
  const auto overshot = [](std::size_t i) {
    return Values{1.0003 * static_cast<double>(i * 5 % 256), 0.99 * static_cast<double>(i * 91 % 256),
                  0.99 * static_cast<double>(i * 53 % 256)};
  };
  const auto fraction = [](std::size_t i) { return Values{static_cast<double>(i % 17) / 17.0}; };
  FileInfo info;
  const NumberTable behind = table_of(60, [&](std::size_t i) { return joined({overshot(i), fraction(i)}); });
  EXPECT_EQ(find_unnamed_colors(behind, false, info), std::nullopt) << "r g b i or i r g b";
  EXPECT_EQ(info.warnings.at(0).id, "undecidable_columns");
  const auto label = [](std::size_t i) { return Values{static_cast<double>(i * 83 % 4096)}; };
  EXPECT_EQ(decide(table_of(60,
                            [&](std::size_t i) {
                              return joined({overshot(i), label(i)});
                            })),
            (ColumnTriple{3, 4, 5}));
  EXPECT_EQ(decide(table_of(60,
                            [&](std::size_t i) {
                              return joined({label(i), overshot(i)});
                            })),
            (ColumnTriple{4, 5, 6}));
}

TEST(UnnamedColumns, IntensityRingAndTimeAreNoColor) {
  EXPECT_EQ(decide(table_of(50,
                            [](std::size_t i) {
                              const auto t = static_cast<double>(i);
                              return Values{std::floor(t / 2), static_cast<double>(i % 16), 0.01 * t};
                            })),
            std::nullopt);
}

/// Channels of one value throughout say nothing.
TEST(UnnamedColumns, ColorsInOneChannel) {
  EXPECT_EQ(decide(table_of(50,
                            [](std::size_t i) {
                              return Values{static_cast<double>(i) + 0.5, 255, 0};
                            })),
            (ColumnTriple{3, 4, 5}));
}

TEST(UnnamedColumns, APtsFileHasTheIntensityFirst) {
  const NumberTable white = table_of(50, [](std::size_t i) { return Values{static_cast<double>(i), 255, 255, 255}; });
  EXPECT_EQ(decide(white, true), (ColumnTriple{4, 5, 6}));
}

TEST(UnnamedColumns, WhatItIsNotIsSaid) {
  FileInfo zero;
  find_unnamed_colors(table_of(9, [](std::size_t) { return Values{0, 0, 0}; }), false, zero);
  EXPECT_THAT(zero.notes.at(0), HasSubstr("zero throughout"));
  FileInfo five;
  find_unnamed_colors(table_of(9, [](std::size_t) { return Values{7, 8}; }), false, five);
  EXPECT_THAT(five.notes.at(0), HasSubstr("columns 4 to 5 ignored"));
  FileInfo negative;
  find_unnamed_colors(table_of(9, [](std::size_t) { return Values{7, 8, -3}; }), false, negative);
  EXPECT_THAT(negative.notes.at(0), HasSubstr("columns 4 to 6 ignored"));
}

TEST(UnnamedColumns, PureColorsOfOneAreUndecidable) {
  // (1,0,0), (0,1,0), (0,0,1): primary colors, or the normals of a box.
  FileInfo info;
  const NumberTable axes = table_of(9, [](std::size_t i) {
    Values v{0, 0, 0};
    v[i % 3] = 1;
    return v;
  });
  EXPECT_EQ(find_unnamed_colors(axes, false, info), std::nullopt);
  EXPECT_EQ(info.warnings.at(0).id, "undecidable_columns");
}

}  // namespace unnamed_columns_test
}  // namespace cmap
