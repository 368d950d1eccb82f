#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/io/point_cloud_file.hpp"
#include "io/line_reader.hpp"

namespace cmap {

/// Cuts the next column off the front of a line: columns are separated by blanks, by one comma, or by one semicolon,
/// with blanks around. False at the end of the line; a separator at the very end is none.
bool next_column(std::string_view& line, std::string_view& column);

std::vector<std::string> split_columns(std::string_view line);

/// Which columns of a text file hold position and color.
struct TextLayout {
  std::size_t columns = 0;
  std::array<std::size_t, 3> position{0, 1, 2};
  std::optional<std::array<std::size_t, 3>> color;
};

/// The layout of a file whose columns have these names (of a header line; empty: none) and whose first line of numbers
/// is `first`. Throws InputError if that cannot be a point; notes what was assumed.
TextLayout text_layout(const LineReader& lines, const std::vector<std::string>& names, std::string_view first,
                       FileInfo& info);

/// Whether a comment is a header line in disguise ("//X Y Z R G B"): it names x, y and z.
bool names_axes(const std::vector<std::string>& names);

}  // namespace cmap
