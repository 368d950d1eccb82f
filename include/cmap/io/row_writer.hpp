#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <string>

#include "cmap/io/output_file.hpp"

namespace cmap {

/// Collects values, binary (little endian) or as text, and writes them in large blocks.
class RowWriter {
 public:
  explicit RowWriter(OutputFile& file) : file_(file) { block_.reserve(kBlock + kSpare); }

  template <class T>
  void put_binary(T value) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    block_.append(bytes.data(), bytes.size());
  }
  /// The shortest text that reads back as the same value, and a blank.
  template <class T>
  void put_text(T value) {
    std::array<char, 32> text;
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size() - 1, value);
    *end = ' ';
    block_.append(text.data(), end + 1);
  }
  /// Ends a line of text.
  void end_line() { block_.back() = '\n'; }
  /// To be called after each row, which must be far smaller than a block.
  void end_row() {
    if (block_.size() >= kBlock) flush();
  }
  void flush();

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 18;
  static constexpr std::size_t kSpare = std::size_t{1} << 12;
  OutputFile& file_;
  std::string block_;
};

}  // namespace cmap
