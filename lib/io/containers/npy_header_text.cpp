#include "containers/npy_header_text.hpp"

#include <algorithm>
#include <charconv>

namespace cmap {

std::string_view NpyHeaderText::take_string() {
  skip_blanks();
  if (text_.empty() || (text_[0] != '\'' && text_[0] != '"')) fail();
  const std::size_t end = text_.find(text_[0], 1);
  if (end == std::string_view::npos) fail();
  const std::string_view content = text_.substr(1, end - 1);
  text_.remove_prefix(end + 1);
  return content;
}

bool NpyHeaderText::take_truth() {
  skip_blanks();
  for (const bool value : {false, true}) {
    const std::string_view word = value ? "True" : "False";
    if (!text_.starts_with(word)) continue;
    text_.remove_prefix(word.size());
    return value;
  }
  fail();
}

std::uint64_t NpyHeaderText::take_number() {
  skip_blanks();
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), number);
  if (error != std::errc()) fail();
  text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
  take('L');  // Python 2's long numbers
  return number;
}

std::vector<std::uint64_t> NpyHeaderText::take_shape() {
  constexpr std::size_t kMostDimensions = 32;  // NumPy's own limit
  if (!take('(')) return {take_number()};
  std::vector<std::uint64_t> shape;
  while (!take(')')) {
    if (shape.size() == kMostDimensions) fail();
    shape.push_back(take_number());
    if (!take(',') && !next_is(')')) fail();
  }
  return shape;
}

bool NpyHeaderText::next_is(char c) {
  skip_blanks();
  return text_.starts_with(c);
}

bool NpyHeaderText::take(char c) {
  if (!next_is(c)) return false;
  text_.remove_prefix(1);
  return true;
}

void NpyHeaderText::expect(char c) {
  if (!take(c)) fail();
}

bool NpyHeaderText::at_end() {
  skip_blanks();
  return text_.empty();
}

void NpyHeaderText::fail() const { source_.fail("NPY header: malformed before '{}'", text_.substr(0, 20)); }

void NpyHeaderText::skip_blanks() { text_.remove_prefix(std::min(text_.size(), text_.find_first_not_of(" \t\r\n"))); }

}  // namespace cmap
