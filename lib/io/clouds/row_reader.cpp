#include "clouds/row_reader.hpp"

#include <algorithm>
#include <limits>

#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

/// How many characters make a line a comment: "#", "##", "//", MATLAB's "%"; 0: it is none.
std::size_t comment_sign(std::string_view line) {
  if (line.starts_with("//")) return 2;
  return std::min(line.size(), line.find_first_not_of("#%"));
}

bool begins_with_number(std::string_view line) {
  std::string_view first;
  double ignored = 0.0;
  return next_column(line, first) && parse_number(first, ignored);
}

char separator_of_names(std::string_view line) {
  const std::size_t found = line.find_first_of(";,");
  return found == std::string_view::npos ? ' ' : line[found];
}

}  // namespace

bool RowReader::next() {
  do {
    if (!lines_.next(line_)) return false;
    line_ = without_blanks(line_);
    if (const std::size_t sign = comment_sign(line_); sign > 0) {
      comment_ = without_blanks(line_.substr(sign));
      line_ = {};
    }
    line_ = without_blanks(without_comment(line_));
  } while (line_.empty());
  split();
  return true;
}

void RowReader::split() {
  if (!format_ && begins_with_number(line_)) format_ = row_format(lines_.source(), line_, lines_.number());
  const char separator = format_ ? format_->separator : separator_of_names(line_);
  split_row(line_, separator, cells_);
  const bool ends_open = line_.back() == separator;
  // A separator at the end ends the last cell, unless that is the empty one behind it.
  if (n_columns_ == 0) n_columns_ = cells_.size() + (ends_open && cells_.back().empty() ? 1 : 0);
  if (cells_.size() + 1 == n_columns_ && ends_open) cells_.emplace_back();
}

double RowReader::number(std::size_t column) const {
  const std::string_view cell = cells_[column];
  double value = std::numeric_limits<double>::quiet_NaN();
  if (!cell.empty() && !parse_column(cell, format(), value)) {
    lines_.fail("'{}' is not a number", cell.substr(0, 40));
  }
  return value;
}

}  // namespace cmap
