#include "io/number_text.hpp"

#include <charconv>
#include <cmath>
#include <limits>

namespace cmap {
namespace {

template <class T>
bool parse_whole(std::string_view token, T& value) {
  if (token.size() > 1 && token.front() == '+' && token[1] != '-') token.remove_prefix(1);
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (error == std::errc()) return stop == end;
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
  }
  return false;
}

}  // namespace

bool parse_number(std::string_view token, double& value) { return parse_whole(token, value); }
bool parse_number(std::string_view token, float& value) { return parse_whole(token, value); }
bool parse_number(std::string_view token, unsigned long long& value) { return parse_whole(token, value); }

}  // namespace cmap
