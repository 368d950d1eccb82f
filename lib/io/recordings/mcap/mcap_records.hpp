#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace cmap {

// The records of an MCAP file (mcap.dev/spec, version 0): opcode, length, body; numbers little-endian.
namespace mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

enum Opcode : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kStatistics = 11,
  kDataEnd = 15
};

inline constexpr std::size_t kRecordStart = 9;    ///< opcode and length
inline constexpr std::size_t kMessageStart = 22;  ///< of its body: channel, sequence, both times
inline constexpr std::size_t kFooterBytes = 20;   ///< of its body

struct Channel {
  std::uint16_t schema = 0;
  std::string topic, message_encoding;
  bool operator==(const Channel&) const = default;
};

struct ChunkStart {
  std::int64_t first_ns = 0, last_ns = 0;
  std::uint64_t uncompressed_bytes = 0;
  std::uint32_t crc = 0;
  std::string compression;
  std::uint64_t compressed_bytes = 0;
  std::size_t bytes = 0;  ///< of all this
};

struct MessageStart {
  std::uint16_t channel = 0;
  std::int64_t log_time_ns = 0;
};

/// What a file says of its channels. The first word counts: a file may repeat it, but not change it.
struct Channels {
  std::map<std::uint16_t, Channel> by_id;
  std::map<std::uint16_t, std::string> type_of_schema;

  void add_channel(std::span<const std::byte> body);
  void add_schema(std::span<const std::byte> body);
  /// Empty: the channel has no schema.
  std::string type_of(const Channel& channel) const;
};

MessageStart message_start(std::span<const std::byte> body);
/// Of the beginning of a chunk's body, which is all that must be there.
ChunkStart chunk_start(std::span<const std::byte> beginning);
std::map<std::uint16_t, std::uint64_t> messages_of_channels(std::span<const std::byte> statistics);

}  // namespace mcap
}  // namespace cmap
