#include "io/line_reader.hpp"

#include <cstring>

namespace cmap {

bool LineReader::next(std::string_view& line) {
  std::span<const std::byte> window = source_.peek(1);
  if (window.empty()) return false;
  ++number_;
  const void* end = std::memchr(window.data(), '\n', window.size());
  while (end == nullptr && window.size() < source_.remaining()) {
    if (window.size() >= source_.block_bytes()) fail("is longer than {} bytes", source_.block_bytes());
    window = source_.peek(window.size() + 1);
    end = std::memchr(window.data(), '\n', window.size());
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
