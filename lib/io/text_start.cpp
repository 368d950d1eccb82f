#include "io/text_start.hpp"

#include <algorithm>
#include <limits>

#include "io/number_text.hpp"

namespace cmap {
namespace {

std::string_view without_comment_mark(std::string_view line) {
  return line.substr(std::min(line.size(), line.find_first_not_of("#/ \t")));
}

std::string first_column(std::string_view line) {
  std::string_view column;
  return next_column(line, column) ? std::string(column) : "";
}

/// A row begins with a number, or, behind a label, has enough of them for a point.
bool is_row(std::string_view line) {
  constexpr std::size_t kFewest = 3;
  std::size_t n_numbers = 0, n = 0;
  double value = 0.0;
  for (std::string_view column; next_column(line, column); ++n) {
    if (!parse_column(column, {}, value)) continue;
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

}  // namespace

bool is_comment_line(std::string_view line) {
  line.remove_prefix(std::min(line.size(), line.find_first_not_of(" \t")));
  return line.starts_with('#') || line.starts_with("//");
}

bool is_blank_line(std::string_view line) { return std::all_of(line.begin(), line.end(), is_blank); }

TextStart read_text_start(LineReader& lines) {
  TextStart start;
  std::string_view line;
  read_lines_before_rows(lines, start, line);
  start.format = row_format(lines.source(), line, lines.number());
  do {
    if (is_blank_line(line) || is_comment_line(line)) continue;
    start.rows.push_back({lines.number(), std::string(line)});
    if (start.rows.size() == TextStart::kRows) return start;
  } while (lines.next(line));
  start.whole = true;
  return start;
}

NumberTable number_table(const TextStart& start) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string_view> columns;
  split_row(start.rows.front().text, start.format.separator, columns);
  NumberTable table{columns.size(), {}};
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
