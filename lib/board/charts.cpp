#include "charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ranges>
#include <utility>

#include "cmap/core/round_number.hpp"
#include "cmap/report/table_text.hpp"
#include "score_table.hpp"

namespace cmap {
namespace {

using Color = Drawing::Color;
using Anchor = Drawing::Anchor;
using Points = std::vector<std::array<double, 2>>;

constexpr Color kPaper{255, 255, 255}, kInk{27, 31, 36}, kMuted{110, 118, 129}, kGrid{226, 230, 234};
/// Okabe and Ito's colors, which color-blind readers tell apart; the yellow left out, as it fades on white.
constexpr Color kColors[]{{0, 114, 178},  {213, 94, 0},  {0, 158, 115}, {204, 121, 167},
                          {86, 180, 233}, {230, 159, 0}, {90, 90, 90}};

constexpr double kWidth = 1200.0, kMargin = 24.0, kGap = 32.0, kTitleSize = 15.0, kTextSize = 13.0;

Color color_of_report(std::size_t i) { return kColors[i % std::size(kColors)]; }

/// Reports after the last color take the first again, hollow.
bool is_hollow(std::size_t report) { return report >= std::size(kColors); }

/// At most `n` characters, beginning and end: names often differ in their ends.
std::string shortened(const std::string& text, std::size_t n) {
  const std::size_t length = character_count(text);
  if (length <= n) return text;
  const std::size_t n_start = (n - 1) / 2, n_end = n - 1 - n_start;
  std::string start, end;
  std::size_t characters = 0;
  for (char c : text) {
    characters += (static_cast<unsigned char>(c) & 0xC0) != 0x80 ? 1 : 0;
    if (characters <= n_start) start += c;
    if (characters > length - n_end) end += c;
  }
  return start + "…" + end;
}

struct Panel {
  double x, y, width;
};

/// Places panels of one height in rows.
class Grid {
 public:
  Grid(double top, std::size_t columns, double panel_height)
      : top_(top),
        columns_(columns),
        height_(panel_height),
        width_((kWidth - 2 * kMargin - kGap * static_cast<double>(columns - 1)) / static_cast<double>(columns)) {}

  Panel panel(std::size_t i) const {
    const auto column = static_cast<double>(i % columns_), row = static_cast<double>(i / columns_);
    return {kMargin + column * (width_ + kGap), top_ + row * (height_ + kGap), width_};
  }
  double bottom(std::size_t n) const {
    return n == 0 ? top_ : top_ + static_cast<double>((n + columns_ - 1) / columns_) * (height_ + kGap);
  }

 private:
  double top_;
  std::size_t columns_;
  double height_, width_;
};

/// Draws on one drawing.
class Charts {
 public:
  explicit Charts(const std::vector<std::string>& names) : names_(names) {}

  void text(double x, double y, const std::string& words, double size, Color color, Anchor anchor = Anchor::kLeft) {
    drawing.shapes.emplace_back(Drawing::Text{x, y, words, size, color, anchor});
  }
  void box(double x, double y, double width, double height, Color color) {
    drawing.shapes.emplace_back(Drawing::Box{x, y, width, height, color});
  }
  /// A box in the color of a report.
  void report_box(double x, double y, double width, double height, std::size_t report) {
    constexpr double kRim = 1.6;
    box(x, y, width, height, color_of_report(report));
    if (!is_hollow(report) || width < 2.0 * kRim || height < 2.0 * kRim) return;
    box(x + kRim, y + kRim, width - 2.0 * kRim, height - 2.0 * kRim, kPaper);
  }
  void line(Points points, Color color, double width) {
    drawing.shapes.emplace_back(Drawing::Line{std::move(points), color, width});
  }

  /// Colors and names; returns where it ends.
  double legend(double top);
  void bars(const Panel& panel, const BarChart& chart);
  void curves(const Panel& panel, const CurveChart& chart);
  void note(double top, const std::string& words) { text(kMargin, top, words, kTextSize, kMuted); }

  static constexpr double kBarHeight = 22.0, kHeadHeight = 28.0, kCurveHeadHeight = 40.0, kPlotHeight = 220.0,
                          kAxisHeight = 44.0;
  Drawing drawing;

 private:
  void axes(const Panel& panel, double left, double x_end, double y_end, const std::string& x_title);
  void range(double from, double to, double y);
  void dashes(const Points& points, Color color);

  const std::vector<std::string>& names_;
};

double Charts::legend(double top) {
  constexpr double kSwatch = 14.0, kRow = 24.0, kLetter = 0.62;  // width of a letter, about
  double x = kMargin, y = top + kRow / 2.0;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::string name = shortened(names_[i], 60);
    const double width = kSwatch + 8.0 + kLetter * kTitleSize * static_cast<double>(character_count(name)) + 24.0;
    if (x > kMargin && x + width > kWidth - kMargin) {
      x = kMargin;
      y += kRow;
    }
    report_box(x, y - kSwatch / 2.0, kSwatch, kSwatch, i);
    text(x + kSwatch + 8.0, y, name, kTitleSize, kInk);
    x += width;
  }
  return y + kRow / 2.0 + kGap / 2.0;
}

/// From where to where the bars and their ranges go, zero among it; an infinite one a little farther than the others.
Range span_of(const BarChart& chart) {
  constexpr double kFarther = 1.25;
  double low = 0.0, high = 0.0;
  bool is_endless = false;
  for (const auto& range : chart.ranges) {
    low = std::min(low, range.value_or(Range{}).first);
    high = std::max(high, range.value_or(Range{}).second);
  }
  for (const double value : chart.values | std::views::transform([](const auto& v) { return v.value_or(0.0); })) {
    is_endless = is_endless || std::isinf(value);
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return {low, is_endless ? std::max(kFarther * high, 1.0) : high};
}

/// Ink on a rim of paper, to be seen on bar and page.
void Charts::range(double from, double to, double y) {
  constexpr double kCap = 4.0;
  for (const auto& [color, width] : {std::pair(kPaper, 3.6), std::pair(kInk, 1.4)}) {
    line({{from, y}, {to, y}}, color, width);
    for (const double end : {from, to}) line({{end, y - kCap}, {end, y + kCap}}, color, width);
  }
}

void Charts::bars(const Panel& panel, const BarChart& chart) {
  constexpr double kNameShare = 0.28, kValueShare = 0.24;
  text(panel.x, panel.y + kHeadHeight / 2.0, chart.title, kTitleSize, kInk);
  const auto [low, high] = span_of(chart);
  const double left = panel.x + kNameShare * panel.width, room = (1.0 - kNameShare - kValueShare) * panel.width;
  const double scale = high > low ? room / (high - low) : 0.0;
  const double zero = left - low * scale;
  for (std::size_t i = 0; i < chart.values.size(); ++i) {
    const double y = panel.y + kHeadHeight + (static_cast<double>(i) + 0.5) * kBarHeight;
    text(left - 8.0, y, shortened(names_[i], 12), kTextSize, kMuted, Anchor::kRight);
    double end = zero + std::clamp(chart.values[i].value_or(0.0), low, high) * scale;
    if (chart.values[i]) {
      report_box(std::min(zero, end), y - 0.36 * kBarHeight, std::abs(end - zero), 0.72 * kBarHeight, i);
    }
    if (!chart.ranges.empty() && chart.ranges[i]) {
      const auto [least, most] = *chart.ranges[i];
      range(zero + least * scale, zero + most * scale, y);
      end = std::max(end, zero + most * scale);
    }
    text(std::max(zero, end) + 6.0, y, chart.texts[i], kTextSize, kInk);
  }
  const double bottom = panel.y + kHeadHeight + static_cast<double>(chart.values.size()) * kBarHeight;
  line({{zero, panel.y + kHeadHeight}, {zero, bottom}}, kMuted, 1.0);
}

void Charts::axes(const Panel& panel, double left, double x_end, double y_end, const std::string& x_title) {
  constexpr int kTicks = 4;
  const double top = panel.y + kCurveHeadHeight, bottom = top + kPlotHeight, right = panel.x + panel.width;
  for (int i = 0; i <= kTicks; ++i) {
    const double share = static_cast<double>(i) / kTicks;
    const double y = bottom - share * kPlotHeight, x = left + share * (right - left);
    line({{left, y}, {right, y}}, i == 0 ? kMuted : kGrid, 1.0);
    text(left - 8.0, y, fmt::format("{:.4g}", share * y_end), kTextSize, kMuted, Anchor::kRight);
    line({{x, bottom}, {x, bottom + 4.0}}, kMuted, 1.0);
    text(x, bottom + 14.0, fmt::format("{:.4g}", share * x_end), kTextSize, kMuted,
         i == kTicks ? Anchor::kRight : Anchor::kCenter);
  }
  text((left + right) / 2.0, bottom + 32.0, x_title, kTextSize, kMuted, Anchor::kCenter);
}

/// The stretches of a curve between its missing values, placed.
template <class PlaceOf>
std::vector<Points> runs_of(const std::vector<double>& x, const std::vector<std::optional<double>>& y,
                            PlaceOf&& place_of) {
  std::vector<Points> runs(1);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (y[i]) {
      runs.back().push_back(place_of(x[i], *y[i]));
    } else if (!runs.back().empty()) {
      runs.emplace_back();
    }
  }
  if (runs.back().empty()) runs.pop_back();
  return runs;
}

/// Single lines, as a drawing knows no dashes; they go on around corners.
void Charts::dashes(const Points& points, Color color) {
  constexpr double kDash = 6.0, kPeriod = 10.0;
  double passed = 0.0;  // along the curve
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto &from = points[i - 1], &to = points[i];
    const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
    if (length == 0.0) continue;
    const auto at = [&](double way) -> std::array<double, 2> {
      const double share = std::clamp(way / length, 0.0, 1.0);
      return {from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])};
    };
    const double first = std::floor(passed / kPeriod) * kPeriod - passed;
    for (double start = first; start < length; start += kPeriod) {
      if (start + kDash > 0.0) line({at(start), at(start + kDash)}, color, 1.6);
    }
    passed += length;
  }
}

void Charts::curves(const Panel& panel, const CurveChart& chart) {
  constexpr double kLabels = 56.0, kDot = 6.0;
  text(panel.x, panel.y + kHeadHeight / 2.0, chart.title, kTitleSize, kInk);
  double highest = 0.0;
  for (const auto* curves : {&chart.y, &chart.dashed}) {
    for (const auto& values : *curves) {
      for (const auto& value : values) highest = std::max(highest, value.value_or(0.0));
    }
  }
  const double x_end = round_number_above(*std::ranges::max_element(chart.x)), y_end = round_number_above(highest);
  const double left = panel.x + kLabels, bottom = panel.y + kCurveHeadHeight + kPlotHeight;
  axes(panel, left, x_end, y_end, chart.x_title);
  const auto place_of = [&](double x, double y) -> std::array<double, 2> {
    return {left + x / x_end * (panel.x + panel.width - left), bottom - y / y_end * kPlotHeight};
  };
  for (std::size_t report = 0; report < chart.dashed.size(); ++report) {
    for (const Points& run : runs_of(chart.x, chart.dashed[report], place_of)) dashes(run, color_of_report(report));
  }
  for (std::size_t report = 0; report < chart.y.size(); ++report) {
    for (const Points& run : runs_of(chart.x, chart.y[report], place_of)) {
      if (run.size() > 1) line(run, color_of_report(report), 2.0);
      for (const auto& [x, y] : run) report_box(x - kDot / 2.0, y - kDot / 2.0, kDot, kDot, report);
    }
  }
}

}  // namespace

Drawing draw_charts(const std::vector<std::string>& names, const std::vector<BarChart>& bars,
                    const std::vector<CurveChart>& curves, const std::string& note) {
  Charts charts(names);
  const Grid bar_grid(charts.legend(kMargin), 3,
                      Charts::kHeadHeight + Charts::kBarHeight * static_cast<double>(names.size()));
  for (std::size_t i = 0; i < bars.size(); ++i) charts.bars(bar_grid.panel(i), bars[i]);
  const Grid curve_grid(bar_grid.bottom(bars.size()), 2,
                        Charts::kCurveHeadHeight + Charts::kPlotHeight + Charts::kAxisHeight);
  for (std::size_t i = 0; i < curves.size(); ++i) charts.curves(curve_grid.panel(i), curves[i]);
  const double bottom = curve_grid.bottom(curves.size()) - kGap + kMargin;
  if (!note.empty()) charts.note(bottom, note);
  charts.drawing.width = kWidth;
  charts.drawing.height = bottom + (note.empty() ? 0.0 : kMargin);
  return std::move(charts.drawing);
}

}  // namespace cmap
