#include "cmap/io/number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace cmap {
namespace {

/// Before Visual Studio 2015 printf wrote "1.#" and a word for what is no number, cut and even rounded like digits:
/// 1.#INF, 1.#QNAN, -1.#IND, 1.#QNAN0, 1.#R (1.#QNAN to two digits). Only #INF in full is surely infinite.
template <class T>
bool parse_msvc(std::string_view token, T& value) {
  const bool negative = token.starts_with('-');
  if (negative || token.starts_with('+')) token.remove_prefix(1);
  if (!token.starts_with("1.#") || token.size() < 4) return false;
  const std::string_view word = token.substr(3);
  const auto is_part = [](char c) { return (c >= 'A' && c <= 'Z') || c == '0'; };
  if (word.front() == '0' || !std::all_of(word.begin(), word.end(), is_part)) return false;
  const T magnitude =
      word.starts_with("INF") ? std::numeric_limits<T>::infinity() : std::numeric_limits<T>::quiet_NaN();
  value = negative ? -magnitude : magnitude;
  return true;
}

template <class T>
bool parse_whole(std::string_view token, T& value) {
  if (token.size() > 1 && token.front() == '+' && token[1] != '-') token.remove_prefix(1);
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (error == std::errc() && stop == end) return true;
  if constexpr (std::is_floating_point_v<T>) {
    if (error == std::errc::result_out_of_range && stop == end) {
      // Only a negative exponent, or a long run of zeros after the point, makes a number too small.
      const std::size_t exponent = token.find_first_of("eE");
      const bool tiny = exponent == std::string_view::npos ? token.find_first_of("123456789") > token.find('.')
                                                           : token.substr(exponent + 1, 1) == "-";
      const T magnitude = tiny ? T{0} : std::numeric_limits<T>::infinity();
      value = token.front() == '-' ? -magnitude : magnitude;
      return true;
    }
    return parse_msvc(token, value);
  }
  return false;
}

}  // namespace

std::string_view without_comment(std::string_view line) {
  const auto within_number = [&](std::size_t sign) {
    return line.substr(0, sign).ends_with("1.") && sign + 1 < line.size() && line[sign + 1] >= 'A' &&
           line[sign + 1] <= 'Z';
  };
  std::size_t sign = line.find('#');
  while (sign != std::string_view::npos && within_number(sign)) sign = line.find('#', sign + 1);
  return line.substr(0, sign);
}

bool parse_number(std::string_view token, double& value) { return parse_whole(token, value); }
bool parse_number(std::string_view token, float& value) { return parse_whole(token, value); }
bool parse_number(std::string_view token, unsigned long long& value) { return parse_whole(token, value); }

}  // namespace cmap
