#include "recordings/mcap/file_window.hpp"

#include <algorithm>

#include "recordings/mcap/crc32.hpp"

namespace cmap::mcap {

std::span<const std::byte> FileWindow::look(std::uint64_t place, std::size_t n) {
  constexpr std::size_t kLeast = 4096;
  if (place < begin_ || place + n > begin_ + filled_) {
    const std::size_t wanted = std::max(n, kLeast);
    if (bytes_.size() < wanted) bytes_.resize(wanted);
    begin_ = place;
    filled_ = source_.read_at(place, std::span(bytes_).first(wanted));
  }
  const std::size_t from = std::min<std::uint64_t>(place - begin_, filled_);
  return std::span(bytes_).subspan(from, std::min(n, filled_ - from));
}

std::uint32_t crc_of_file(const ByteSource& source, std::uint64_t begin, std::uint64_t end) {
  Array<std::byte> block(std::size_t{1} << 20);
  std::uint32_t crc = 0;
  while (begin < end) {
    const std::size_t wanted = std::min<std::uint64_t>(block.size(), end - begin);
    const std::size_t n = source.read_at(begin, std::span(block).first(wanted));
    if (n == 0) break;
    crc = crc32_of(std::span(block).first(n), crc);
    begin += n;
  }
  return crc;
}

}  // namespace cmap::mcap
