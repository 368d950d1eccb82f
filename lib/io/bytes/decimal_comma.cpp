#include "bytes/decimal_comma.hpp"

#include <algorithm>

#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

bool separates(char c) { return is_blank(c) || c == ';'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view next_piece(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && separates(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !separates(line[end])) ++end;
  const std::string_view piece = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return piece;
}

bool has_comma_between_digits(std::string_view piece) {
  const std::size_t comma = piece.find(',');
  return comma != std::string_view::npos && comma > 0 && comma + 1 < piece.size() && is_digit(piece[comma - 1]) &&
         is_digit(piece[comma + 1]);
}

}  // namespace

bool has_decimal_commas(std::string_view line) {
  std::size_t n_pieces = 0, n_with_comma = 0;
  for (std::string_view piece; !(piece = next_piece(line)).empty(); ++n_pieces) {
    const auto n_commas = std::count(piece.begin(), piece.end(), ',');
    if (n_commas > 1 || piece.starts_with(',') || piece.ends_with(',')) return false;
    n_with_comma += has_comma_between_digits(piece);
  }
  return n_pieces > 1 && n_with_comma > 0;
}

}  // namespace cmap
