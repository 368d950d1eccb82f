#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cmap/core/drawing.hpp"

namespace cmap {

/// From the least to the greatest that a value may be.
using Range = std::pair<double, double>;

/// One number of every report as bars; a missing one is a dash. A range is a line over its bar.
struct BarChart {
  std::string title;
  std::vector<std::optional<double>> values;
  std::vector<std::string> texts;
  std::vector<std::optional<Range>> ranges = {};  ///< by report; empty: none
};

/// One line for each report; a missing value interrupts it. Dashed lines have the colors of their reports.
struct CurveChart {
  using Curves = std::vector<std::vector<std::optional<double>>>;

  std::string title, x_title;
  std::vector<double> x;
  Curves y;            ///< by report
  Curves dashed = {};  ///< by report; empty: none
};

/// All charts of these reports, each report in one color throughout, and a line of text under them.
Drawing draw_charts(const std::vector<std::string>& names, const std::vector<BarChart>& bars,
                    const std::vector<CurveChart>& curves, const std::string& note = "");

/// The drawing as an SVG file: text stays text.
std::string svg(const Drawing& drawing);

}  // namespace cmap
