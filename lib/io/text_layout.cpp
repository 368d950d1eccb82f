#include "io/text_layout.hpp"

#include <algorithm>
#include <cctype>

#include "io/number_text.hpp"

namespace cmap {
namespace {

bool is_separator(char c) { return c == ',' || c == ';'; }

std::string_view skip_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  return text;
}

std::string normalized(std::string_view name) {
  while (!name.empty() && (name.front() == '"' || name.front() == '\'')) name.remove_prefix(1);
  while (!name.empty() && (name.back() == '"' || name.back() == '\'')) name.remove_suffix(1);
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return lower;
}

using Names = std::vector<std::string>;
using Triple = std::array<std::string_view, 3>;
constexpr Triple kAxes{"x", "y", "z"};

std::optional<std::array<std::size_t, 3>> find_triple(const Names& names, const Triple& wanted) {
  std::array<std::size_t, 3> places{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found =
        std::find_if(names.begin(), names.end(), [&](const auto& name) { return normalized(name) == wanted[k]; });
    if (found == names.end()) return std::nullopt;
    places[k] = static_cast<std::size_t>(found - names.begin());
  }
  return places;
}

void assign_by_name(const Names& names, std::array<std::size_t, 3> position, TextLayout& layout) {
  layout.position = position;
  layout.color = find_triple(names, {"red", "green", "blue"});
  if (!layout.color) layout.color = find_triple(names, {"r", "g", "b"});
}

void assign_by_place(bool has_header, TextLayout& layout, FileInfo& info) {
  const std::size_t n = layout.columns;
  if (has_header)
    info.notes.emplace_back("the header line does not name x, y and z: taken to be the first three columns");
  if (n == 6) {
    layout.color = {3, 4, 5};
    info.notes.emplace_back("columns 4 to 6 taken as red, green and blue");
  } else if (n > 3) {
    info.notes.push_back(fmt::format("column{} ignored; a header line such as 'x y z r g b' would say what {} hold{}",
                                     n == 4 ? " 4" : fmt::format("s 4 to {}", n), n == 4 ? "it" : "they",
                                     n == 4 ? "s" : ""));
  }
}

}  // namespace

bool next_column(std::string_view& line, std::string_view& column) {
  line = skip_blanks(line);
  if (line.empty()) return false;
  std::size_t end = 0;
  while (end < line.size() && !is_blank(line[end]) && !is_separator(line[end])) ++end;
  column = line.substr(0, end);
  line = skip_blanks(line.substr(end));
  if (!line.empty() && is_separator(line.front())) line.remove_prefix(1);
  return true;
}

std::vector<std::string> split_columns(std::string_view line) {
  std::vector<std::string> columns;
  for (std::string_view column; next_column(line, column);) columns.emplace_back(column);
  return columns;
}

bool names_axes(const std::vector<std::string>& names) { return find_triple(names, kAxes).has_value(); }

TextLayout text_layout(const LineReader& lines, const Names& names, std::string_view first, FileInfo& info) {
  if (first.find(';') != std::string_view::npos && first.find(',') != std::string_view::npos) {
    lines.fail("mixes ';' and ','; decimal commas cannot be read");
  }
  TextLayout layout;
  layout.columns = split_columns(first).size();
  if (layout.columns < 3) lines.fail("{} columns; at least x y z expected", layout.columns);
  if (!names.empty() && names.size() != layout.columns) {
    lines.fail("{} columns, but the header line names {}", layout.columns, names.size());
  }
  if (const auto position = find_triple(names, kAxes)) {
    assign_by_name(names, *position, layout);
  } else {
    assign_by_place(!names.empty(), layout, info);
  }
  return layout;
}

}  // namespace cmap
