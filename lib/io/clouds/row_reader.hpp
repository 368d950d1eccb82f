#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clouds/text/text_row.hpp"
#include "cmap/io/line_reader.hpp"

namespace cmap {

/// The cells of the lines of a table; comments (`#`, `%`, `//`, also behind a row) and blank lines are passed over.
/// What separates the cells is decided by the first line that begins with a number (row_format).
class RowReader {
 public:
  explicit RowReader(ByteSource& source) : lines_(source) {}

  /// The next line with cells; false at the end. Throws InputError as row_format() does.
  bool next();
  /// Valid until the next call of next().
  const std::vector<std::string_view>& cells() const { return cells_; }
  std::string_view line() const { return line_; }
  /// The cell as a number, NaN where it is empty; throws InputError naming the line for anything else.
  double number(std::size_t column) const;
  /// The last comment line so far, without its sign.
  const std::string& comment() const { return comment_; }
  /// What is known of the rows' format; the default before the first row.
  RowFormat format() const { return format_.value_or(RowFormat{}); }
  const LineReader& lines() const { return lines_; }

 private:
  void split();

  LineReader lines_;
  std::string_view line_;
  std::vector<std::string_view> cells_;
  std::optional<RowFormat> format_;
  std::size_t n_columns_ = 0;  ///< of the first line
  std::string comment_;
};

}  // namespace cmap
