#include <fmt/format.h>

#include "charts.hpp"
#include "score_table.hpp"

namespace cmap {
namespace {

std::string hex(const Drawing::Color& color) {
  return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
}

std::string markup(const Drawing::Line& line) {
  std::string points;
  for (const auto& [x, y] : line.points) points += fmt::format("{}{:.2f},{:.2f}", points.empty() ? "" : " ", x, y);
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\"/>\n", points,
                     hex(line.color), line.width);
}

std::string markup(const Drawing::Box& box) {
  return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n", box.x, box.y,
                     box.width, box.height, hex(box.color));
}

std::string markup(const Drawing::Text& text) {
  const char* anchor = text.anchor == Drawing::Anchor::kLeft     ? "start"
                       : text.anchor == Drawing::Anchor::kCenter ? "middle"
                                                                 : "end";
  constexpr double kBaseline = 0.36;  // below the middle of capitals, of the size
  return fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:g}\" fill=\"{}\" text-anchor=\"{}\">{}</text>\n",
                     text.x, text.y + kBaseline * text.size, text.size, hex(text.color), anchor,
                     escaped_html(text.text));
}

}  // namespace

std::string svg(const Drawing& drawing) {
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" viewBox=\"0 0 {0:g} {1:g}\" "
      "font-family=\"DejaVu Sans, Liberation Sans, Arial, sans-serif\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"#ffffff\"/>\n",
      drawing.width, drawing.height);
  for (const auto& shape : drawing.shapes) text += std::visit([](const auto& s) { return markup(s); }, shape);
  return text + "</svg>\n";
}

}  // namespace cmap
