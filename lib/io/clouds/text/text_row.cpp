#include "clouds/text/text_row.hpp"

#include <algorithm>
#include <cctype>

#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

/// Cuts a cell off the front of a line, up to what `ends` holds for: without the blanks and quotes around it. What
/// stands between quotes is of the cell.
template <class Test>
std::string_view next_cell(std::string_view& line, Test&& ends) {
  const auto find_end = [&](std::size_t from) {
    while (from < line.size() && !ends(line[from])) ++from;
    return from;
  };
  std::size_t end = find_end(0);
  std::size_t first = 0;
  while (first < end && is_blank(line[first])) ++first;
  if (first < line.size() && (line[first] == '"' || line[first] == '\'')) {
    const std::size_t close = line.find(line[first], first + 1);
    const std::size_t behind = close == std::string_view::npos ? end : find_end(close);
    // Behind the closing quote the cell ends; a quote elsewhere is a letter (5" X').
    if (close != std::string_view::npos && without_blanks(line.substr(close + 1, behind - close - 1)).empty()) {
      const std::string_view cell = without_blanks(line.substr(first + 1, close - first - 1));
      line.remove_prefix(behind);
      return cell;
    }
  }
  const std::string_view cell = without_blanks(line.substr(0, end));
  line.remove_prefix(end);
  return cell;
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

/// The cells between commas with a blank beside them, where other commas have none: "1,5, 2,5, 3,5".
std::vector<std::string_view> cells_at_loose_commas(std::string_view row) {
  std::vector<std::string_view> cells;
  std::size_t begin = 0, n_tight = 0;
  for (std::size_t i = row.find(','); i != std::string_view::npos; i = row.find(',', i + 1)) {
    const bool loose = i == 0 || i + 1 == row.size() || is_blank(row[i - 1]) || is_blank(row[i + 1]);
    n_tight += loose ? 0 : 1;
    if (!loose) continue;
    cells.push_back(without_blanks(row.substr(begin, i - begin)));
    begin = i + 1;
  }
  cells.push_back(without_blanks(row.substr(begin)));
  return n_tight == 0 ? std::vector<std::string_view>{} : cells;
}

/// Whether a row of whole numbers may be three or more numbers with decimal commas, separated by commas with blanks.
bool may_be_decimal_at_loose_commas(std::string_view row) {
  const std::vector<std::string_view> cells = cells_at_loose_commas(row);
  return cells.size() >= 3 && std::all_of(cells.begin(), cells.end(), may_have_decimal_comma);
}

}  // namespace

bool next_column(std::string_view& line, std::string_view& column) {
  line = without_blanks(line);
  if (line.empty()) return false;
  column = next_cell(line, [](char c) { return is_blank(c) || is_separator(c); });
  line = without_blanks(line);
  if (!line.empty() && is_separator(line.front())) line.remove_prefix(1);
  return true;
}

void split_row(std::string_view line, char separator, std::vector<std::string_view>& columns) {
  columns.clear();
  line = without_blanks(line);
  while (!line.empty()) {
    if (separator == ' ') {
      columns.push_back(next_cell(line, is_blank));
      line = without_blanks(line);
    } else {
      columns.push_back(next_cell(line, [separator](char c) { return c == separator; }));
      if (!line.empty()) line.remove_prefix(1);
    }
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
  const auto has_comma = [](std::string_view column) { return holds(column, ','); };
  // Commas are left between quotes alone: of numbers, or of labels.
  const auto is_decimal = [](std::string_view column) {
    double ignored = 0.0;
    return holds(column, ',') && may_have_decimal_comma(column) && parse_column(column, {',', true}, ignored);
  };
  if (std::any_of(columns.begin(), columns.end(), is_decimal)) {
    const auto has_point = [](std::string_view column) {
      double ignored = 0.0;
      return holds(column, '.') && parse_number(column, ignored);
    };
    if (std::none_of(columns.begin(), columns.end(), has_point)) return {',', true};
    source.fail("line {}: commas between quotes beside decimal points; decimal commas cannot be told from others",
                number);
  }
  if (std::any_of(columns.begin(), columns.end(), has_comma)) return {',', false};
  const auto has_blank = [](std::string_view column) { return std::any_of(column.begin(), column.end(), is_blank); };
  if (std::none_of(columns.begin(), columns.end(), has_blank)) {
    if (!may_be_decimal_at_loose_commas(row)) return {',', false};
    source.fail(
        "line {}: some commas have blanks beside them and others not; decimal commas cannot be told from separators "
        "(decimal points, or ';' between the numbers, would)",
        number);
  }
  // Blanks within what commas separate: blanks are the separators, and every column must have its comma.
  split_row(row, ' ', columns);
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
