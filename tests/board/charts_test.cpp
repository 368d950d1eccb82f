#include "charts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cmap {
namespace charts_test {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

template <class Shape>
std::vector<Shape> shapes_of(const Drawing& drawing) {
  std::vector<Shape> found;
  for (const auto& shape : drawing.shapes) {
    if (const auto* s = std::get_if<Shape>(&shape)) found.push_back(*s);
  }
  return found;
}

std::vector<std::string> texts_of(const Drawing& drawing) {
  std::vector<std::string> texts;
  for (const Drawing::Text& text : shapes_of<Drawing::Text>(drawing)) texts.push_back(text.text);
  return texts;
}

/// The boxes that are no swatches of the legend.
std::vector<Drawing::Box> bars_of(const Drawing& drawing, std::size_t n_reports) {
  std::vector<Drawing::Box> boxes = shapes_of<Drawing::Box>(drawing);
  boxes.erase(boxes.begin(), boxes.begin() + static_cast<std::ptrdiff_t>(n_reports));
  return boxes;
}

TEST(Charts, BarsAreProportionalAndNothingHasNone) {
  const auto bars = bars_of(draw_charts({"a", "b", "c"}, {{"t", {2.0, 1.0, {}}, {"2", "1", "-"}}}, {}), 3);
  ASSERT_EQ(bars.size(), 2u) << "a dash is no bar";
  EXPECT_DOUBLE_EQ(bars[0].width, 2.0 * bars[1].width);
  EXPECT_DOUBLE_EQ(bars[0].x, bars[1].x);
}

TEST(Charts, NegativeBarsGoTheOtherWay) {
  const auto bars = bars_of(draw_charts({"a", "b"}, {{"t", {-1.0, 3.0}, {"-1", "3"}}}, {}), 2);
  EXPECT_NEAR(bars[0].x + bars[0].width, bars[1].x, 1e-9) << "they meet at zero";
  EXPECT_DOUBLE_EQ(bars[1].width, 3.0 * bars[0].width);
}

TEST(Charts, AnInfiniteBarIsTheLongest) {
  const auto bars = bars_of(draw_charts({"a", "b"}, {{"t", {INFINITY, 40.0}, {"∞", "40"}}}, {}), 2);
  EXPECT_DOUBLE_EQ(bars[0].width, 1.25 * bars[1].width);
  const auto alone = bars_of(draw_charts({"a"}, {{"t", {INFINITY}, {"∞"}}}, {}), 1);
  ASSERT_EQ(alone.size(), 1u);
  EXPECT_TRUE(std::isfinite(alone[0].width));
  EXPECT_GT(alone[0].width, 0.0);
}

/// Where the lines of that width go.
std::vector<Drawing::Line> lines_of(const Drawing& drawing, double width) {
  std::vector<Drawing::Line> lines = shapes_of<Drawing::Line>(drawing);
  std::erase_if(lines, [&](const Drawing::Line& line) { return line.width != width; });
  return lines;
}

TEST(Charts, ARangeLiesOverItsBar) {
  const Drawing drawing = draw_charts({"a", "b"}, {{"t", {2.0, 1.0}, {"2", "1"}, {Range{1.0, 4.0}, {}}}}, {}, "a note");
  const auto bars = bars_of(drawing, 2);
  const auto lines = lines_of(drawing, 1.4);
  ASSERT_EQ(lines.size(), 3u) << "with a cap at each end";
  const double zero = bars[0].x, unit = bars[0].width / 2.0;
  EXPECT_NEAR(lines[0].points[0][0], zero + unit, 1e-9);
  EXPECT_NEAR(lines[0].points[1][0], zero + 4.0 * unit, 1e-9);
  EXPECT_LE(zero + 4.0 * unit, drawing.width);
  for (const Drawing::Text& text : shapes_of<Drawing::Text>(drawing)) {
    if (text.text != "2") continue;
    EXPECT_GT(text.x, zero + 4.0 * unit) << "behind the range";
  }
  EXPECT_THAT(texts_of(drawing), Contains("a note"));
}

TEST(Charts, DashesFollowTheirCurve) {
  const CurveChart curve{"t", "x", {0.0, 1.0}, {{0.0, 1.0}}, {{0.5, 0.5}}};
  const auto dashes = lines_of(draw_charts({"a"}, {}, {curve}), 1.6);
  ASSERT_GT(dashes.size(), 10u);
  double drawn = 0.0;
  for (const Drawing::Line& dash : dashes) {
    EXPECT_EQ(dash.points[0][1], dash.points[1][1]) << "level";
    drawn += dash.points[1][0] - dash.points[0][0];
  }
  const double whole = dashes.back().points[1][0] - dashes.front().points[0][0];
  EXPECT_NEAR(drawn / whole, 0.6, 0.02) << "6 pixels of 10";
}

TEST(Charts, AMissingValueInterruptsItsCurve) {
  const CurveChart curve{"t", "x", {0.1, 0.2, 0.3, 0.4, 0.5}, {{1.0, 2.0, {}, 4.0, 5.0}}};
  int lines_of_report = 0;
  for (const Drawing::Line& line : shapes_of<Drawing::Line>(draw_charts({"a"}, {}, {curve}))) {
    lines_of_report += line.width > 1.0 ? 1 : 0;
  }
  EXPECT_EQ(lines_of_report, 2);
}

TEST(Charts, EverythingStaysInside) {
  const std::vector<std::string> names(9, "a rather long name of a method, 2nd version");
  const std::vector<std::optional<double>> nothing(9);
  const Drawing drawing = draw_charts(names, {{"t", nothing, std::vector<std::string>(9, "-")}},
                                      {{"t", "x", {0.1}, std::vector(9, std::vector<std::optional<double>>{0.0})}});
  for (const Drawing::Box& box : shapes_of<Drawing::Box>(drawing)) {
    EXPECT_GE(box.x, 0.0);
    EXPECT_LE(box.x + box.width, drawing.width);
    EXPECT_LE(box.y + box.height, drawing.height);
  }
}

TEST(Charts, NamesKeepTheirEnds) {
  const Drawing drawing = draw_charts({"a_long_name_of_method_1", "µµµµµµµµµµµµ"}, {{"t", {1.0, 1.0}, {"1", "1"}}}, {});
  EXPECT_THAT(texts_of(drawing), Contains("a_lon…thod_1"));
  EXPECT_THAT(texts_of(drawing), Contains("µµµµµµµµµµµµ"));
}

TEST(Svg, HasTheShapesAndEscapesTheTexts) {
  Drawing drawing{100.0, 50.0, {}};
  drawing.shapes.emplace_back(Drawing::Box{1.0, 2.0, 3.0, 4.0, {255, 0, 16}});
  drawing.shapes.emplace_back(Drawing::Line{{{0.0, 0.0}, {10.0, 5.5}}, {0, 0, 0}, 2.0});
  drawing.shapes.emplace_back(Drawing::Text{5.0, 10.0, "<a> & b", 10.0, {1, 2, 3}, Drawing::Anchor::kRight});
  const std::string text = svg(drawing);
  EXPECT_THAT(text, HasSubstr("viewBox=\"0 0 100 50\""));
  EXPECT_THAT(text, HasSubstr("<rect x=\"1.00\" y=\"2.00\" width=\"3.00\" height=\"4.00\" fill=\"#ff0010\"/>"));
  EXPECT_THAT(text, HasSubstr("<polyline points=\"0.00,0.00 10.00,5.50\""));
  EXPECT_THAT(text, HasSubstr("text-anchor=\"end\">&lt;a&gt; &amp; b</text>"));
  EXPECT_THAT(text, Not(HasSubstr("<a>")));
}

}  // namespace charts_test
}  // namespace cmap
