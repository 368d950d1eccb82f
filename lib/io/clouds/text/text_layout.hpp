#pragma once

#include <array>
#include <optional>

#include "clouds/text/text_start.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// Which columns of a text file hold position and color.
struct TextLayout {
  std::size_t columns = 0;
  ColumnTriple position{0, 1, 2};
  std::optional<ColumnTriple> color;
};

/// The layout of a file with this start: by the names of its header line, or of a comment that names as many columns as
/// there are; else the first three are x y z, behind a column that numbers the rows (find_row_numbers), and the numbers
/// decide (find_unnamed_colors). Throws InputError where
/// that makes no point: fewer than three columns, a header that names no coordinates or another number of columns,
/// numbers that are something else (a matrix, poses). Notes what was assumed and what is not used.
TextLayout text_layout(const ByteSource& source, const TextStart& start, FileInfo& info);

}  // namespace cmap
