#pragma once

#include <cstdint>
#include <string_view>

#include "cmap/io/byte_source.hpp"

namespace cmap {

/// The lines of a source, counted from 1, without a UTF-8 byte order mark at its start. LF, CRLF and CR (as on old
/// Macs) end a line, also where a file mixes them. The last line may lack its end. Once a line has ended with a lone
/// CR, an LF behind the CR of the line last read is left to the source: it may be the first byte of what follows a
/// header.
class LineReader {
 public:
  /// Throws InputError for UTF-16.
  explicit LineReader(ByteSource& source);

  /// The next line without its end, valid until the next call; false at the end of the file.
  bool next(std::string_view& line);
  std::uint64_t number() const { return number_; }
  ByteSource& source() { return source_; }

  /// Throws InputError "<name>: line <number>: <reason>".
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> reason, Args&&... args) const {
    source_.fail("line {}: {}", number_, fmt::format(reason, std::forward<Args>(args)...));
  }

 private:
  std::size_t find_end();
  void skip_left_lf();

  ByteSource& source_;
  std::uint64_t number_ = 0;
  char end_ = '\n';         ///< of the last line; where ends are alike, its first search finds the next
  bool lone_cr_ = false;    ///< a line has ended with CR alone
  bool may_be_lf_ = false;  ///< the next byte belongs to the last line's end if it is an LF
};

/// The text without a UTF-8 byte order mark at its start.
std::string_view without_byte_order_mark(std::string_view text);

/// Whether a text is UTF-16 (what PowerShell's redirection wrote), by its byte order mark.
bool starts_as_utf16(std::string_view text);

}  // namespace cmap
