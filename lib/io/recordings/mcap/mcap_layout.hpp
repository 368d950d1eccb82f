#pragma once

#include <optional>
#include <vector>

#include "cmap/io/byte_source.hpp"
#include "recordings/mcap/mcap_records.hpp"
#include "recordings/wire/wire_reader.hpp"

namespace cmap::mcap {

/// Messages that are read at once: a chunk, or messages outside of chunks that follow one another, about a megabyte.
struct Run {
  std::uint64_t begin = 0, end = 0;  ///< bytes of the file, records whole
  std::int64_t first_ns = 0, last_ns = 0;
  bool is_chunk = false;
};

/// What a walk over the records of a file finds, from the first to the last, stepping over messages and chunks: no
/// index is needed.
struct Layout {
  std::vector<Run> runs;                            ///< as they stand in the file
  Channels channels;                                ///< those within chunks only where they are repeated outside
  std::map<std::uint16_t, std::uint64_t> messages;  ///< of messages outside of chunks
  std::optional<std::map<std::uint16_t, std::uint64_t>> statistics;
  /// Why the file is not whole; empty: it is. What stands before can be read.
  std::string fault;
};

/// Throws InputError where it is no MCAP file, or where messages that no chunk's checksum covers are not what the
/// file's checksum says.
Layout read_layout(const ByteSource& source);

/// Calls use(opcode, body, place) for each record in some bytes; place is of the record within them. Throws InputError
/// with the reason alone.
template <class Use>
void for_each_record(std::span<const std::byte> records, Use&& use) {
  std::size_t place = 0;
  while (place < records.size()) {
    WireReader start(MessageEncoding::kRos1, records.subspan(place));
    const auto opcode = start.number<std::uint8_t>();
    const auto length = start.number<std::uint64_t>();
    if (length > start.remaining()) {
      throw InputError(fmt::format("the record at byte {} of the chunk takes {} bytes, but {} are left", place, length,
                                   start.remaining()));
    }
    use(opcode, start.bytes(length), place);
    place += kRecordStart + length;
  }
}

}  // namespace cmap::mcap
