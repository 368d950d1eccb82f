#include "io/text_row.hpp"

#include <algorithm>
#include <cctype>

#include "io/number_text.hpp"

namespace cmap {
namespace {

std::string_view without_quotes(std::string_view text) {
  const auto quoted = [&](char quote) { return text.size() >= 2 && text.front() == quote && text.back() == quote; };
  return quoted('"') || quoted('\'') ? without_blanks(text.substr(1, text.size() - 2)) : text;
}

/// "-1,5" or "3": a number whose only mark is at most one comma between digits.
bool may_have_decimal_comma(std::string_view column) {
  const std::size_t comma = column.find(',');
  if (comma == std::string_view::npos) return column.find('.') == std::string_view::npos;
  const auto is_digit = [&](std::size_t i) {
    return i < column.size() && std::isdigit(static_cast<unsigned char>(column[i]));
  };
  return column.find_first_of(",.", comma + 1) == std::string_view::npos && comma > 0 && is_digit(comma - 1) &&
         is_digit(comma + 1);
}

bool holds(std::string_view text, char c) { return text.find(c) != std::string_view::npos; }

bool all_may_have_decimal_commas(std::string_view row, char separator) {
  std::vector<std::string_view> columns;
  split_row(row, separator, columns);
  return std::all_of(columns.begin(), columns.end(), may_have_decimal_comma);
}

bool is_separator(char c) { return c == ',' || c == ';'; }

}  // namespace

bool next_column(std::string_view& line, std::string_view& column) {
  line = without_blanks(line);
  if (line.empty()) return false;
  std::size_t end = 0;
  while (end < line.size() && !is_blank(line[end]) && !is_separator(line[end])) ++end;
  column = line.substr(0, end);
  line = without_blanks(line.substr(end));
  if (!line.empty() && is_separator(line.front())) line.remove_prefix(1);
  return true;
}

void split_row(std::string_view line, char separator, std::vector<std::string_view>& columns) {
  columns.clear();
  line = without_blanks(line);
  if (separator == ' ') {
    for (std::string_view token = next_token(line); !token.empty(); token = next_token(line)) {
      columns.push_back(without_quotes(token));
    }
    return;
  }
  while (!line.empty()) {
    const std::size_t end = std::min(line.find(separator), line.size());
    columns.push_back(without_quotes(without_blanks(line.substr(0, end))));
    line.remove_prefix(std::min(end + 1, line.size()));
  }
}

RowFormat row_format(const ByteSource& source, std::string_view row, std::uint64_t number) {
  row = without_blanks(row);
  std::size_t n_empty = 0;
  const char last = row.empty() ? ' ' : row.back();
  for (; !row.empty() && is_separator(row.back()); ++n_empty) row = without_blanks(row.substr(0, row.size() - 1));
  // One number and empty cells, as pandas writes NaN.
  if (n_empty > 1 && row.find_first_of(" \t,;") == std::string_view::npos) return {last, false};
  if (!holds(row, ',')) return {holds(row, ';') ? ';' : ' ', false};
  for (const char separator : {';', '\t'}) {
    if (!holds(row, separator)) continue;
    if (all_may_have_decimal_commas(row, separator)) return {separator, true};
    if (separator == ';')
      source.fail("line {}: mixes ';' and ','; decimal commas cannot be told from separators", number);
  }
  std::vector<std::string_view> columns;
  split_row(row, ',', columns);
  const auto has_blank = [](std::string_view column) { return std::any_of(column.begin(), column.end(), is_blank); };
  if (std::none_of(columns.begin(), columns.end(), has_blank)) return {',', false};
  // Blanks within what commas separate: blanks are the separators, and every column must have its comma.
  split_row(row, ' ', columns);
  const auto has_comma = [](std::string_view column) { return holds(column, ','); };
  if (std::all_of(columns.begin(), columns.end(), has_comma) && all_may_have_decimal_commas(row, ' '))
    return {' ', true};
  source.fail("line {}: mixes ',' and blanks; decimal commas cannot be told from separators", number);
}

bool parse_column(std::string_view column, const RowFormat& format, double& value) {
  if (!format.decimal_comma || !holds(column, ',')) return parse_number(column, value);
  std::string with_point(column);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return parse_number(with_point, value);
}

}  // namespace cmap
