#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace cmap {

/// A picture of lines, boxes and texts, for charts: one writer makes SVG of it, another pixels. Lengths are pixels of
/// the SVG, from the upper left corner.
struct Drawing {
  using Color = std::array<std::uint8_t, 3>;

  struct Line {
    std::vector<std::array<double, 2>> points;
    Color color;
    double width;
  };
  struct Box {
    double x, y, width, height;
    Color color;
  };
  enum class Anchor { kLeft, kCenter, kRight };
  /// (x, y) is the anchor on the line's vertical middle.
  struct Text {
    double x, y;
    std::string text;
    double size;
    Color color;
    Anchor anchor;
  };

  double width = 0.0, height = 0.0;
  std::vector<std::variant<Line, Box, Text>> shapes;  ///< later ones lie over earlier ones
};

}  // namespace cmap
