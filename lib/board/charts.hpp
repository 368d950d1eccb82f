#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cmap/core/drawing.hpp"

namespace cmap {

/// One number of every report as bars; a missing one is a dash.
struct BarChart {
  std::string title;
  std::vector<std::optional<double>> values;
  std::vector<std::string> texts;
};

/// One line for each report; a missing value interrupts it.
struct CurveChart {
  std::string title, x_title;
  std::vector<double> x;
  std::vector<std::vector<std::optional<double>>> y;  ///< by report
};

/// All charts of these reports, each report in one color throughout.
Drawing draw_charts(const std::vector<std::string>& names, const std::vector<BarChart>& bars,
                    const std::vector<CurveChart>& curves);

/// The drawing as an SVG file: text stays text.
std::string svg(const Drawing& drawing);

}  // namespace cmap
