#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/io/byte_source.hpp"

namespace cmap {

/// The beginning of a file and its name: what a format is recognized by.
struct FileStart {
  static constexpr std::size_t kBytes = ByteSource::kMaxRecordBytes;

  std::string name;        ///< without folders, lowercase
  std::string extension;   ///< with its dot, lowercase; may be empty
  std::string_view bytes;  ///< at most kBytes, without a UTF-8 byte order mark
  std::uint64_t size = 0;  ///< of the whole file
  bool text = false;       ///< no control characters in the first 4 kB
  bool whole = false;      ///< bytes is all there is

  /// The first lines, at most n, without their ends (LF, CRLF or CR); one that the start cuts off is left out.
  std::vector<std::string_view> lines(std::size_t n) const;
};

/// Looks at a source that nothing was taken from yet. The result is valid until the source moves on.
FileStart file_start(ByteSource& source);

/// The tokens of a line, separated by blanks; at most `most` of them.
std::vector<std::string_view> tokens_of(std::string_view line, std::size_t most);

/// Whether all tokens are numbers, and then which.
bool parse_numbers(const std::vector<std::string_view>& tokens, std::vector<double>& values);

}  // namespace cmap
