#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clouds/point_names.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// The first rows of a table of numbers, or some at equal distances; what is no number is NaN.
struct NumberTable {
  std::size_t columns = 0;
  std::vector<double> values;  ///< row by row
  double row_step = 1.0;       ///< of the file's rows from one to the next
  std::size_t n_before = 0;    ///< columns of the file before the first

  std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
  double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

/// Which columns after x y z are red, green and blue, where no names say so: decided by the numbers among the layouts
/// in use (colors, normals, intensity and alpha in several orders); `intensity_first`: the file's kind (PTS) has the
/// intensity before the color. None, and a note or a warning in `info`, where there are none or it cannot be told.
std::optional<ColumnTriple> find_unnamed_colors(const NumberTable& table, bool intensity_first, FileInfo& info);

/// Whether the first column numbers the rows.
enum class RowNumbers {
  kNone,
  kCertain,      ///< and the next three are x y z
  kUndecidable,  ///< it does, or is an x that grows by one from row to row
};

/// Row numbers are whole, grow by one from 0 or 1, and stand before three columns that look like coordinates: with
/// fractions, where an x in such steps would have none either. Few rows are no evidence.
RowNumbers find_row_numbers(const NumberTable& table);

/// The table without its first column.
NumberTable without_first_column(const NumberTable& table);

}  // namespace cmap
