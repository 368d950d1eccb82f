#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "cmap/io/byte_source.hpp"

namespace cmap {

/// The text of an NPY header, taken apart into what Python's literals are made of. Throws InputError naming the source.
class NpyHeaderText {
 public:
  NpyHeaderText(const ByteSource& source, std::string_view text) : source_(source), text_(text) {}

  std::string_view take_string();
  bool take_truth();
  std::uint64_t take_number();
  /// "(2, 3)", or a lone number.
  std::vector<std::uint64_t> take_shape();

  bool next_is(char c);
  /// Steps over c, if it is next.
  bool take(char c);
  void expect(char c);
  bool at_end();

  /// "malformed before ..."
  [[noreturn]] void fail() const;
  template <class... Args>
  [[noreturn]] void refuse(fmt::format_string<Args...> reason, Args&&... args) const {
    source_.fail("NPY header: {}", fmt::format(reason, std::forward<Args>(args)...));
  }

 private:
  void skip_blanks();

  const ByteSource& source_;
  std::string_view text_;
};

}  // namespace cmap
