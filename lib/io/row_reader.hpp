#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/line_reader.hpp"

namespace cmap {

/// The cells of the lines of a table, comments (`#`, `%`, `//`) and blank lines passed over. One thing separates in a
/// line: semicolons, else commas, else blanks.
class RowReader {
 public:
  explicit RowReader(ByteSource& source) : lines_(source) {}

  /// The next line with cells; false at the end. Throws InputError for decimal commas.
  bool next();
  /// Valid until the next call of next(). A separator at the very end of a line is followed by no cell, unless the
  /// first line had one.
  const std::vector<std::string_view>& cells() const { return cells_; }
  /// The cell as a number, NaN where it is empty; throws InputError naming the line for anything else.
  double number(std::size_t column) const;
  std::string_view line() const { return line_; }
  /// The last comment so far, without its sign.
  const std::string& comment() const { return comment_; }
  const LineReader& lines() const { return lines_; }
  bool has_commas() const { return has_commas_; }

 private:
  void split(std::string_view line);

  LineReader lines_;
  std::vector<std::string_view> cells_;
  std::string_view line_;
  std::size_t n_columns_ = 0;  ///< of the first line
  std::string comment_;
  bool has_commas_ = false;
};

}  // namespace cmap
