// Names of matrices that say which way they map.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

#include "poses/transform_numbers.hpp"

namespace cmap {
namespace {

using Words = std::vector<std::string>;

/// "T_est_ref", "refToEst" and "ref2est" as words in lower case.
Words words_of(std::string_view name) {
  Words words(1);
  char before = ' ';
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_upper = std::isupper(byte) != 0, was_lower = std::islower(static_cast<unsigned char>(before)) != 0;
    if (std::isalnum(byte) == 0 || (is_upper && was_lower) || std::isdigit(byte) != 0) words.emplace_back();
    if (std::isalnum(byte) != 0) words.back() += static_cast<char>(std::tolower(byte));
    if (std::isdigit(byte) != 0) words.emplace_back();
    before = c;
  }
  std::erase(words, "");
  return words;
}

template <std::size_t n>
bool is_one_of(const std::array<std::string_view, n>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_estimate(std::string_view word) {
  return is_one_of(std::array<std::string_view, 3>{"est", "estimate", "estimated"}, word);
}

bool is_reference(std::string_view word) {
  return is_one_of(std::array<std::string_view, 5>{"ref", "reference", "gt", "truth", "groundtruth"}, word);
}

bool is_transform(std::string_view word) {
  return is_one_of(std::array<std::string_view, 3>{"t", "tf", "transform"}, word);
}

bool is_to(std::string_view word) { return word == "to" || word == "2" || word == "into"; }

}  // namespace

bool names_reference_to_estimate(std::string_view name) {
  const Words words = words_of(name);
  for (std::size_t i = 0; i + 2 < words.size(); ++i) {
    const std::string &a = words[i], &b = words[i + 1], &c = words[i + 2];
    if (is_reference(a) && is_to(b) && is_estimate(c)) return true;
    if (is_estimate(a) && (b == "from" || b == "t") && is_reference(c)) return true;
    // T_a_b maps b to a.
    if (is_transform(a) && is_estimate(b) && is_reference(c)) return true;
  }
  return false;
}

std::string reference_to_estimate_error(std::string_view name, std::string_view how_to_invert) {
  return fmt::format(
      "the name '{}' says that the matrix maps the reference to the estimate, but it is the estimate that moves: give "
      "its inverse ({})",
      name, how_to_invert);
}

}  // namespace cmap
