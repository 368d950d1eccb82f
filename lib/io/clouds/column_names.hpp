#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "clouds/text/text_row.hpp"

namespace cmap {

/// The names that a header or comment gives to `n_columns` columns: cut like the rows, or as tabs, commas, semicolons
/// or blanks cut it into that many; also behind a label ("columns: id, x, y"), without numbers for each ("[0] id [1]
/// x") and remarks ("x y z (meters)"). Where no cut makes that many, as the rows are cut.
std::vector<std::string> column_names(std::string_view line, const RowFormat& format, std::size_t n_columns);

}  // namespace cmap
