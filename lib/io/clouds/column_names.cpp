#include "clouds/column_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "clouds/point_names.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

using Names = std::vector<std::string>;

Names cut_at(std::string_view line, char separator) {
  std::vector<std::string_view> columns;
  split_row(line, separator, columns);
  return {columns.begin(), columns.end()};
}

Names cut_anywhere(std::string_view line) {
  Names names;
  for (std::string_view column; next_column(line, column);) names.emplace_back(column);
  return names;
}

/// The first way to cut the line that makes n names of points; empty if none does.
Names cut_into(std::string_view line, std::size_t n, auto&& accepts) {
  for (const char separator : {'\t', ',', ';', '|'}) {
    if (line.find(separator) == std::string_view::npos) continue;
    Names names = cut_at(line, separator);
    if (names.size() == n && accepts(names)) return names;
  }
  Names names = cut_anywhere(line);
  return names.size() == n && accepts(names) ? names : Names{};
}

bool is_whole(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// A line without the places of columns: "[0] id [1] x", "0: id, 1: x", "id=0 x=1".
std::string without_places(std::string_view line) {
  std::string text(line);
  std::replace(text.begin(), text.end(), '=', ' ');
  std::replace(text.begin(), text.end(), ':', ' ');
  std::string names;
  std::string_view rest(text);
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.size(), rest.find_first_of(" \t,;|"));
    std::string_view word = rest.substr(0, end);
    const bool in_brackets = word.size() > 2 && std::string_view("[(").find(word.front()) != std::string_view::npos &&
                             std::string_view("])").find(word.back()) != std::string_view::npos;
    if (!is_whole(in_brackets ? word.substr(1, word.size() - 2) : word)) names += word;
    if (end < rest.size()) names += rest[end];
    rest.remove_prefix(std::min(rest.size(), end + 1));
  }
  return names;
}

/// A line without what stands in brackets behind a blank, units and remarks.
std::string without_remarks(std::string_view line) {
  std::string text;
  while (!line.empty()) {
    const bool opens = (line.front() == '(' || line.front() == '[') && (text.empty() || is_blank(text.back()));
    const std::size_t close = opens ? line.find_first_of(")]") : std::string_view::npos;
    if (close == std::string_view::npos) {
      text += line.front();
      line.remove_prefix(1);
    } else {
      line.remove_prefix(close + 1);
    }
  }
  return text;
}

/// The same with units kept where they stand, at the name before: "x [mm] y [mm]".
std::string with_units_attached(std::string_view line) {
  std::string text;
  for (const char c : line) {
    if (c == '(' || c == '[') {
      while (!text.empty() && is_blank(text.back())) text.pop_back();
    }
    text += c;
  }
  return text;
}

/// Words of a sentence, which is no list of names however many words it has.
bool is_prose(const Names& names) {
  static constexpr std::array<std::string_view, 14> kWords{"in", "and", "of", "the",  "with", "are", "is",
                                                           "as", "per", "to", "from", "for",  "by",  "or"};
  return std::any_of(names.begin(), names.end(),
                     [](const auto& name) { return std::find(kWords.begin(), kWords.end(), name) != kWords.end(); });
}

}  // namespace

std::vector<std::string> column_names(std::string_view line, const RowFormat& format, std::size_t n_columns) {
  while (!line.empty() && std::string_view("/#%!").find(line.front()) != std::string_view::npos) {
    line.remove_prefix(1);
  }
  const auto places_points = [](const Names& found) { return find_point_names(found).position.has_value(); };
  Names names = cut_at(line, format.separator);
  if (names.size() == n_columns && places_points(names)) return names;
  if (Names others = cut_into(line, n_columns, places_points); !others.empty()) return others;
  const std::string_view behind_label = line.substr(std::min(line.size(), line.rfind(':') + 1));
  Names best;
  for (const std::string& text : {std::string(behind_label), without_places(line), without_places(behind_label),
                                  with_units_attached(line), without_remarks(line), without_remarks(behind_label)}) {
    Names others =
        cut_into(text, n_columns, [&](const Names& found) { return places_points(found) && !is_prose(found); });
    // A remark at the end may hide the last name: a cut that shows colors is the better one.
    if (!others.empty() && (best.empty() || (!find_point_names(best).color && find_point_names(others).color))) {
      best = std::move(others);
    }
  }
  if (!best.empty()) return best;
  if (names.size() == n_columns) return names;
  Names others = cut_into(line, n_columns, [](const Names&) { return true; });
  return others.empty() ? names : others;
}

}  // namespace cmap
