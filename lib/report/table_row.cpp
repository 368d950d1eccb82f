#include "table_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "cmap/report/table_text.hpp"

namespace cmap {
namespace {

/// Where a text is cut to be no longer than the width: after a part of the sentence, if that leaves no short line, else
/// after a word; npos of a single word, which stays whole.
std::size_t cut_within(const std::string& text, std::size_t width) {
  std::size_t cut = 0;
  for (const char* end : {", ", "; ", "   "}) {
    const std::size_t place = text.rfind(end, width - 1);
    if (place != text.npos) cut = std::max(cut, place + (*end == ' ' ? 0 : 1));
  }
  if (cut > width / 3) return cut;
  cut = text.rfind(' ', width);
  return cut == text.npos ? text.find(' ') : cut;
}

/// Places are of bytes, which are never fewer than characters.
std::vector<std::string> wrapped(std::string text, std::size_t width) {
  std::vector<std::string> lines;
  while (character_count(text) > width) {
    const std::size_t cut = cut_within(text, width);
    if (cut == text.npos) break;
    lines.push_back(text.substr(0, cut));
    text.erase(0, text.find_first_not_of(' ', cut));
  }
  lines.push_back(std::move(text));
  return lines;
}

std::string without_trailing_blanks(const std::string& line) { return line.substr(0, line.find_last_not_of(' ') + 1); }

/// The remark beside the levels, or what format_row says.
std::string with_remark(std::string line, const std::string& remark, std::size_t width) {
  constexpr std::size_t kLeastColumn = 30, kBelowTitle = 4;
  line += "  ";
  std::size_t column = character_count(line);
  if (column + character_count(remark) > width && column + kLeastColumn > width) {
    column = kBelowTitle;
    line = fmt::format("{}\n{:{}}", without_trailing_blanks(line), "", column);
  }
  const std::size_t room = width > column ? width - column : 1;
  return line + fmt::format("{}", fmt::join(wrapped(remark, room), fmt::format("\n{:{}}", "", column)));
}

}  // namespace

std::string format_row(const TableRow& row, std::size_t width) {
  std::string line = fmt::format("  {} {} {} {} {}{}", padded(row.title, 30), padded(row.symbol, 8), row.arrow,
                                 fmt::format("{:>11}", row.value), padded(row.unit, 10), row.levels);
  if (row.remark.empty()) return without_trailing_blanks(line) + "\n";
  if (row.levels.empty()) return fmt::format("{} {}\n", line, row.remark);
  return with_remark(std::move(line), row.remark, width == 0 ? std::string::npos : width) + "\n";
}

}  // namespace cmap
