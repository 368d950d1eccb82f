#pragma once

#include <string>
#include <string_view>

namespace cmap {

/// A line of the table: the columns of all rows stand at the same places.
struct TableRow {
  std::string_view title;
  std::string symbol = {};
  std::string_view arrow = " ";  ///< which way is better
  std::string value = {};        ///< or one value for each threshold
  std::string unit = {};
  std::string levels = {};  ///< floor, chance and skill; empty in a table without them
  std::string remark = {};
};

/// The row, with its remark in the last column. Within a width of so many characters (0: of any) a remark beside levels
/// goes on in its column, or below the title where that is narrow.
std::string format_row(const TableRow& row, std::size_t width);

}  // namespace cmap
