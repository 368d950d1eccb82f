#include "cmap/core/spelling.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <utility>

namespace cmap {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::size_t edit_distance(std::string_view first, std::string_view second) {
  const std::string a = lower_case(first), b = lower_case(second);
  // Distances of the beginnings of a that end one and two letters earlier, and here, to those of b.
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), here(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) here[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last = std::exchange(last, here);
    here[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      here[j] = std::min({replaced, last[j] + 1, here[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) here[j] = std::min(here[j], before_last[j - 2] + 1);
    }
  }
  return here[b.size()];
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t kFar = std::numeric_limits<std::size_t>::max(), kLongEnough = 3;
  const std::string lower = lower_case(word);
  std::size_t nearest = kFar;
  std::string best;
  for (const std::string& name : known) {
    const std::size_t most = std::max<std::size_t>(1, std::min(word.size(), name.size()) / 3);
    std::size_t distance = edit_distance(word, name);
    if (word.size() >= kLongEnough && lower_case(name).starts_with(lower)) distance = std::min(distance, most);
    if (distance > most || distance >= std::min(nearest, name.size())) continue;
    nearest = distance;
    best = name;
  }
  return best.empty() ? "" : "; did you mean " + best + "?";
}

std::string is_none_of(std::string_view word, const std::vector<std::string>& known) {
  return fmt::format("is none of {}{}", fmt::join(known, ", "), did_you_mean(word, known));
}

}  // namespace cmap
