#include "clouds/text/text_start.hpp"

#include <algorithm>
#include <limits>

#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

/// "; x y z", as INI files comment; ";x;y;z" is a row whose first cell is empty.
bool is_semicolon_comment(std::string_view line) {
  return line.starts_with(';') && line.find(';', 1) == std::string_view::npos;
}

std::string_view without_comment_mark(std::string_view line) {
  line = without_blanks(line);
  if (is_semicolon_comment(line)) line.remove_prefix(1);
  return line.substr(std::min(line.size(), line.find_first_not_of("#/%! \t")));
}

/// Whether the names, but not the numbers, hold blanks: tabs then separate what blanks do not.
bool needs_tabs(std::string_view names, std::string_view row) {
  std::vector<std::string_view> cells;
  split_row(row, ' ', cells);
  const std::size_t by_blanks = cells.size();
  split_row(names, '\t', cells);
  const std::size_t n_names = cells.size();
  split_row(row, '\t', cells);
  return n_names > 1 && cells.size() == n_names && by_blanks != n_names;
}

std::string first_column(std::string_view line) {
  std::string_view column;
  return next_column(line, column) ? std::string(column) : "";
}

/// A row begins with a number, or, behind a label, has enough of them for a point.
bool is_row(std::string_view line) {
  constexpr std::size_t kFewest = 3;
  constexpr RowFormat kAnyComma{' ', true};  // next_column() leaves commas only between quotes
  std::size_t n_numbers = 0, n = 0;
  double value = 0.0;
  for (std::string_view column; next_column(line, column); ++n) {
    if (!parse_column(column, kAnyComma, value)) continue;
    if (n == 0 || ++n_numbers == kFewest) return true;
  }
  return false;
}

/// A line that announces how many points follow (PTS, CloudCompare, survey exports).
std::optional<std::uint64_t> count_of(std::string_view line) {
  unsigned long long count = 0;
  const std::string_view token = next_token(line);
  if (!next_token(line).empty() || !parse_number(token, count)) return std::nullopt;
  return count;
}

/// Comments, header and count line; `line` is then the first row.
void read_lines_before_rows(LineReader& lines, TextStart& start, std::string_view& line) {
  while (lines.next(line)) {
    if (is_blank_line(line)) continue;
    if (is_comment_line(line)) {
      start.comments.push_back({lines.number(), std::string(without_comment_mark(line))});
    } else if (!start.count && count_of(line)) {
      start.count = count_of(line);
    } else if (is_row(line)) {
      return;
    } else if (start.header) {
      lines.fail("'{}' is not a number (taken for text, x y z [r g b], as no other format was recognized)",
                 first_column(line).substr(0, 40));
    } else {
      start.header = TextLine{lines.number(), std::string(line)};
    }
  }
  lines.source().fail("holds no line of numbers");
}

bool has_leading_zero(std::string_view cell) { return cell.size() > 1 && cell.front() == '0'; }

/// "3,05,-1,5,0,25": behind the commas stand digits that no whole number begins with.
bool has_decimals_as_columns(const std::vector<TextLine>& rows, const RowFormat& format) {
  bool any_zero = false;
  std::vector<std::string_view> cells;
  for (const TextLine& row : rows) {
    split_row(row.text, format.separator, cells);
    if (cells.size() < 6 || cells.size() % 2 != 0) return false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool may_be_decimals = i % 2 == 1;
      if (!may_be_decimals && cells[i].starts_with('-')) cells[i].remove_prefix(1);
      if (cells[i].empty() || cells[i].find_first_not_of("0123456789") != std::string_view::npos) return false;
      if (!may_be_decimals && has_leading_zero(cells[i])) return false;
      any_zero = any_zero || has_leading_zero(cells[i]);
    }
  }
  return any_zero;
}

void refuse_decimals_as_columns(const ByteSource& source, const TextStart& start) {
  if (start.format.separator != ',' || start.format.decimal_comma) return;
  if (!has_decimals_as_columns(start.rows, start.format)) return;
  source.fail(
      "line {}: commas between whole numbers, of which some begin with 0: decimal commas cannot be told from "
      "separators (decimal points, or ';' between the numbers, would)",
      start.rows.front().number);
}

}  // namespace

bool is_comment_line(std::string_view line) {
  line.remove_prefix(std::min(line.size(), line.find_first_not_of(" \t")));
  return line.starts_with('#') || line.starts_with("//") || line.starts_with('%') || line.starts_with('!') ||
         is_semicolon_comment(line);
}

bool is_blank_line(std::string_view line) { return std::all_of(line.begin(), line.end(), is_blank); }

TextStart read_text_start(LineReader& lines) {
  TextStart start;
  std::string_view line;
  read_lines_before_rows(lines, start, line);
  start.format = row_format(lines.source(), line, lines.number());
  if (start.format.separator == ' ' && start.header && needs_tabs(start.header->text, line)) {
    start.format.separator = '\t';
  }
  do {
    if (is_blank_line(line) || is_comment_line(line)) continue;
    start.rows.push_back({lines.number(), std::string(line)});
  } while (start.rows.size() < TextStart::kRows && lines.next(line));
  start.whole = start.rows.size() < TextStart::kRows;
  refuse_decimals_as_columns(lines.source(), start);
  return start;
}

NumberTable number_table(const TextStart& start) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string_view> columns;
  split_row(start.rows.front().text, start.format.separator, columns);
  const std::string_view first = without_blanks(start.rows.front().text);
  const bool ends_empty = !columns.empty() && columns.back().empty() && first.back() == start.format.separator;
  NumberTable table{columns.size() + (ends_empty ? 1 : 0), {}};
  for (const TextLine& row : start.rows) {
    split_row(row.text, start.format.separator, columns);
    columns.resize(table.columns);
    for (const std::string_view column : columns) {
      double value = kNaN;
      if (!parse_column(column, start.format, value)) value = kNaN;
      table.values.push_back(value);
    }
  }
  return table;
}

}  // namespace cmap
