#pragma once

// Lines of tables and the columns of their characters.

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "report/report_testing.hpp"

namespace cmap::test {

inline std::vector<std::string> lines_of(const std::string& table) {
  std::vector<std::string> lines;
  std::istringstream stream(table);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The first line with this text; fails the test if there is none.
inline std::string line_with(const std::string& table, const std::string& text) {
  for (const std::string& line : lines_of(table)) {
    if (line.find(text) != std::string::npos) return line;
  }
  ADD_FAILURE() << "no line with \"" << text << "\" in\n" << table;
  return {};
}

/// Characters before a byte of a UTF-8 text.
inline std::ptrdiff_t column_of(const std::string& line, std::size_t byte) {
  return std::count_if(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(byte),
                       [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
}

}  // namespace cmap::test
