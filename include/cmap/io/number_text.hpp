#pragma once

#include <string_view>

namespace cmap {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r'; }

/// The text without the blanks around it.
inline std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Cuts the next token, ended by blanks, off the front of `text`; empty when none is left.
inline std::string_view next_token(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && is_blank(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !is_blank(text[end])) ++end;
  const std::string_view token = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return token;
}

/// A line up to its comment: the first '#' but for those within MSVC's numbers that are none (1.#QNAN).
std::string_view without_comment(std::string_view line);

/// The whole token as a number, whatever the locale; "nan" and "inf" are numbers, also as MSVC writes them (1.#QNAN,
/// -1.#IND, 1.#INF, nan(ind)), a leading '+' is allowed. A number beyond the type's range becomes infinite, one below
/// it zero. False if the token is anything else.
bool parse_number(std::string_view token, double& value);
bool parse_number(std::string_view token, float& value);
bool parse_number(std::string_view token, unsigned long long& value);

}  // namespace cmap
