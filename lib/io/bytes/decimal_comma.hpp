#pragma once

#include <string_view>

namespace cmap {

/// Whether the commas of a line stand within its numbers ("1,5 0,25" or "1,5;0,25") and not between them ("1,5,0",
/// "1, 5", "1,0,0;0,1,0"): something else separates too, and no piece between holds more than one.
bool has_decimal_commas(std::string_view line);

}  // namespace cmap
