#pragma once

#include <vector>

#include "cmap/io/byte_source.hpp"

namespace cmap::mcap {

/// Reads the beginnings of records through a small window, as chunks are stepped over.
class FileWindow {
 public:
  explicit FileWindow(const ByteSource& source) : source_(source) {}

  /// The next n bytes at a place, fewer at the end of the file; valid until the next call.
  std::span<const std::byte> look(std::uint64_t place, std::size_t n);

 private:
  const ByteSource& source_;
  std::vector<std::byte> bytes_;
  std::uint64_t begin_ = 0;
  std::size_t filled_ = 0;
};

/// The checksum of a part of a file.
std::uint32_t crc_of_file(const ByteSource& source, std::uint64_t begin, std::uint64_t end);

}  // namespace cmap::mcap
