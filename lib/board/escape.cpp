#include <fmt/format.h>

#include "cmap/report/table_text.hpp"
#include "score_table.hpp"

namespace cmap {
namespace {

using Replacements = std::initializer_list<std::pair<std::string_view, std::string_view>>;

/// Replaces whatever the text holds, from left to right.
std::string replaced(std::string_view text, Replacements replacements) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t length = 1;
    std::string_view instead = text.substr(i, 1);
    for (const auto& [from, to] : replacements) {
      if (!text.substr(i).starts_with(from)) continue;
      length = from.size();
      instead = to;
      break;
    }
    out += instead;
    i += length;
  }
  return out;
}

}  // namespace

std::string one_line(std::string_view text) {
  std::string line = valid_utf8(text);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  // The control characters above ASCII, and those that turn the direction of writing around.
  return replaced(line, {{"\xc2\x85", " "},
                         {"\xc2\x9b", " "},
                         {"\xe2\x80\xa8", " "},
                         {"\xe2\x80\xa9", " "},
                         {"\xe2\x80\xad", " "},
                         {"\xe2\x80\xae", " "}});
}

std::string escaped_markdown(std::string_view text) {
  return replaced(one_line(text), {{"\\", "\\\\"},
                                   {"|", "\\|"},
                                   {"*", "\\*"},
                                   {"_", "\\_"},
                                   {"`", "\\`"},
                                   {"[", "\\["},
                                   {"]", "\\]"},
                                   {"#", "\\#"},
                                   {"~", "\\~"},
                                   {"$", "\\$"},
                                   {"&", "&amp;"},
                                   {"<", "&lt;"},
                                   {">", "&gt;"}});
}

std::string escaped_latex(std::string_view text) {
  // A row that begins with [ or * would be an argument of the line break before it.
  return replaced(one_line(text), {{"\\", "\\textbackslash{}"},
                                   {"{", "\\{"},
                                   {"}", "\\}"},
                                   {"$", "\\$"},
                                   {"&", "\\&"},
                                   {"#", "\\#"},
                                   {"_", "\\_"},
                                   {"%", "\\%"},
                                   {"~", "\\textasciitilde{}"},
                                   {"^2", "$^2$"},
                                   {"^", "\\textasciicircum{}"},
                                   {"<=", "$\\leq$"},
                                   {"<", "\\textless{}"},
                                   {">", "\\textgreater{}"},
                                   {"\"", "''"},
                                   {"↓", "$\\downarrow$"},
                                   {"↑", "$\\uparrow$"},
                                   {"Δ", "$\\Delta$"},
                                   {"×", "$\\times$"},
                                   {"±", "$\\pm$"},
                                   {"∞", "$\\infty$"},
                                   {"[", "{[}"},
                                   {"]", "{]}"},
                                   {"*", "{*}"},
                                   {"|", "\\textbar{}"}});
}

std::string escaped_html(std::string_view text) {
  return replaced(one_line(text), {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}, {"'", "&#39;"}});
}

std::string csv_field(std::string_view text) {
  const std::string line = one_line(text);
  if (line.find_first_of(",\"") == line.npos && (line.empty() || (line.front() != ' ' && line.back() != ' ')))
    return line;
  return fmt::format("\"{}\"", replaced(line, {{"\"", "\"\""}}));
}

std::string csv_digits(std::string number) {
  const std::size_t point = number.find('.');
  const std::size_t decimals = point == number.npos ? 0 : std::min(number.find('e', point), number.size()) - point - 1;
  constexpr std::size_t kOfThousands = 3;
  if (decimals == kOfThousands) number.insert(point + 1 + decimals, 1, '0');
  return number;
}

std::string csv_number(const std::optional<double>& value) {
  return value ? csv_digits(fmt::format("{}", *value)) : "";
}

}  // namespace cmap
