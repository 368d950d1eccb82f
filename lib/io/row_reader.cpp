#include "io/row_reader.hpp"

#include <algorithm>
#include <limits>

#include "io/decimal_comma.hpp"
#include "io/number_text.hpp"

namespace cmap {
namespace {

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// How many characters make a line a comment: "#", "##", "//", MATLAB's "%"; 0: it is none.
std::size_t comment_sign(std::string_view line) {
  if (line.starts_with("//")) return 2;
  return std::min(line.size(), line.find_first_not_of("#%"));
}

}  // namespace

bool RowReader::next() {
  std::string_view line;
  do {
    if (!lines_.next(line)) return false;
    line = without_blanks(line);
    if (const std::size_t sign = comment_sign(line); sign > 0) {
      comment_ = without_blanks(line.substr(sign));
      line = {};
    }
    line = without_blanks(without_comment(line));
  } while (line.empty());
  if (has_decimal_commas(line)) lines_.fail("decimal commas; write the numbers with points");
  line_ = line;
  split(line);
  if (n_columns_ == 0 || cells_.size() > n_columns_) {
    if (cells_.back().empty()) cells_.pop_back();
  }
  if (n_columns_ == 0) n_columns_ = cells_.size();
  return true;
}

void RowReader::split(std::string_view line) {
  cells_.clear();
  has_commas_ = line.find(',') != std::string_view::npos;
  const bool has_semicolons = line.find(';') != std::string_view::npos;
  if (!has_commas_ && !has_semicolons) {
    for (std::string_view cell; !(cell = next_token(line)).empty();) cells_.push_back(cell);
    return;
  }
  const char separator = has_semicolons ? ';' : ',';
  for (;;) {
    const std::size_t end = line.find(separator);
    cells_.push_back(without_blanks(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

double RowReader::number(std::size_t column) const {
  const std::string_view cell = cells_[column];
  double value = std::numeric_limits<double>::quiet_NaN();
  if (!cell.empty() && !parse_number(cell, value)) lines_.fail("'{}' is not a number", cell.substr(0, 40));
  return value;
}

}  // namespace cmap
