#include "cmap/io/line_reader.hpp"

#include <algorithm>

namespace cmap {
namespace {

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return text;
}

bool starts_as_utf16(std::string_view text) { return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"); }

LineReader::LineReader(ByteSource& source) : source_(source) {
  const std::string_view start =
      as_text(source.peek(std::min<std::uint64_t>(source.block_bytes(), source.remaining())));
  if (source.position() != 0) return;
  if (starts_as_utf16(start)) source.fail("is UTF-16 text; save it as UTF-8");
  source.advance(start.size() - without_byte_order_mark(start).size());
}

void LineReader::skip_left_lf() {
  if (!may_be_lf_) return;
  may_be_lf_ = false;
  if (as_text(source_.peek(1)).starts_with('\n')) source_.advance(1);
}

/// The place of the next CR or LF, npos where the last line has none. The window then holds the byte behind it too.
std::size_t LineReader::find_end() {
  for (std::size_t wanted = 2;; wanted = source_.peek(1).size() + 1) {
    const std::string_view window = as_text(source_.peek(std::min(wanted, source_.block_bytes())));
    // The other kind is looked for only before the usual one, lest a file of one kind be searched again and again.
    const std::size_t usual = window.find(end_);
    const std::size_t other = window.substr(0, usual).find(end_ == '\n' ? '\r' : '\n');
    const std::size_t end = std::min(usual, other);
    const bool is_all = window.size() >= source_.remaining();
    if (is_all || (end != std::string_view::npos && end + 1 < window.size())) return end;
    if (window.size() >= source_.block_bytes()) fail("is longer than {} bytes", source_.block_bytes());
  }
}

bool LineReader::next(std::string_view& line) {
  skip_left_lf();
  if (source_.peek(1).empty()) return false;
  ++number_;
  const std::size_t end = find_end();
  const std::string_view window = as_text(source_.peek(1));
  line = window.substr(0, end);
  if (end == std::string_view::npos) {
    source_.advance(line.size());
    return true;
  }
  end_ = window[end];
  const bool crlf = end_ == '\r' && window.substr(end + 1).starts_with('\n');
  if (crlf) end_ = '\n';
  may_be_lf_ = crlf && lone_cr_;
  lone_cr_ = lone_cr_ || end_ == '\r';
  source_.advance(end + (crlf && !may_be_lf_ ? 2 : 1));
  return true;
}

}  // namespace cmap
