#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cmap/io/line_reader.hpp"

namespace cmap {

/// Cuts the next column off the front of a line, whatever separates it: blanks, one comma or one semicolon, with blanks
/// around; what stands between quotes is one column. False at the end of the line; a separator at the very end is none.
bool next_column(std::string_view& line, std::string_view& column);

/// How the rows of a text file are cut into columns: by one separator, with blanks around it.
struct RowFormat {
  char separator = ' ';        ///< ' ' for any blanks, ',', ';' or a tab
  bool decimal_comma = false;  ///< 1,5 is one and a half; where commas separate too, such numbers are in quotes
};

/// The format of a file whose first row of numbers is `row`, line `number`. Throws InputError for a row that mixes
/// separators, or whose commas may separate columns or decimals.
RowFormat row_format(const ByteSource& source, std::string_view row, std::uint64_t number);

/// The columns of a line, without blanks and quotes around them; a separator between quotes separates nothing. One at
/// the very end makes no column.
void split_row(std::string_view line, char separator, std::vector<std::string_view>& columns);

/// A column as a number; false if it is none.
bool parse_column(std::string_view column, const RowFormat& format, double& value);

}  // namespace cmap
