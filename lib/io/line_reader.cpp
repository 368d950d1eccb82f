#include "io/line_reader.hpp"

#include <algorithm>
#include <cstring>

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
  if (source.position() == 0 && starts_as_utf16(start)) source.fail("is UTF-16 text; save it as UTF-8");
  const std::size_t first_end = start.find_first_of("\r\n");
  const bool lone_cr = first_end != start.npos && first_end + 1 < start.size() && start[first_end] == '\r' &&
                       start[first_end + 1] != '\n';
  if (lone_cr) end_ = '\r';
  if (source.position() == 0) source.advance(start.size() - without_byte_order_mark(start).size());
}

bool LineReader::next(std::string_view& line) {
  std::span<const std::byte> window = source_.peek(1);
  if (window.empty()) return false;
  ++number_;
  const void* end = std::memchr(window.data(), end_, window.size());
  while (end == nullptr && window.size() < source_.remaining()) {
    if (window.size() >= source_.block_bytes()) fail("is longer than {} bytes", source_.block_bytes());
    window = source_.peek(window.size() + 1);
    end = std::memchr(window.data(), end_, window.size());
  }
  const auto* begin = reinterpret_cast<const char*>(window.data());
  const std::size_t length =
      end == nullptr ? window.size() : static_cast<std::size_t>(static_cast<const char*>(end) - begin);
  line = {begin, length};
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  source_.advance(end == nullptr ? length : length + 1);
  return true;
}

}  // namespace cmap
