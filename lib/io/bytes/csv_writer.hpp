#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "cmap/core/error.hpp"

namespace cmap {

/// The text as a cell of a table. Throws UsageError if it cannot be one: CsvTable knows no quotes.
inline std::string_view csv_cell(std::string_view text) {
  const bool blank_end = !text.empty() && (text.front() == ' ' || text.back() == ' ');
  if (text.empty() || blank_end || text.find_first_of(",\"\t\r\n") != std::string_view::npos) {
    throw UsageError(
        fmt::format("'{}' cannot be written into a table: commas, quotes and line ends have no place", text));
  }
  return text;
}

}  // namespace cmap
