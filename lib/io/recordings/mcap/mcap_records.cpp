#include "recordings/mcap/mcap_records.hpp"

#include "recordings/wire/wire_reader.hpp"

namespace cmap::mcap {
namespace {

/// MCAP writes numbers and texts as ROS 1 does.
WireReader fields_of(std::span<const std::byte> body) { return WireReader(MessageEncoding::kRos1, body); }

/// Times are of 64 bits without a sign; those beyond the year 2262 are all the same.
std::int64_t time_of(WireReader& fields) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 63;
  return static_cast<std::int64_t>(std::min(fields.number<std::uint64_t>(), kMost - 1));
}

}  // namespace

void Channels::add_schema(std::span<const std::byte> body) {
  WireReader fields = fields_of(body);
  const auto id = fields.number<std::uint16_t>();
  const std::string type(fields.text());
  const auto [place, is_new] = type_of_schema.emplace(id, type);
  if (!is_new && place->second != type) fields.fail("schema {} is {}, and was {}", id, type, place->second);
}

void Channels::add_channel(std::span<const std::byte> body) {
  WireReader fields = fields_of(body);
  const auto id = fields.number<std::uint16_t>();
  Channel channel;
  channel.schema = fields.number<std::uint16_t>();
  channel.topic = fields.text();
  channel.message_encoding = fields.text();
  const auto [place, is_new] = by_id.emplace(id, channel);
  if (!is_new && place->second != channel) {
    fields.fail("channel {} is of {}, and was of {}", id, channel.topic, place->second.topic);
  }
}

std::string Channels::type_of(const Channel& channel) const {
  const auto found = type_of_schema.find(channel.schema);
  return found == type_of_schema.end() ? std::string() : found->second;
}

MessageStart message_start(std::span<const std::byte> body) {
  WireReader fields = fields_of(body);
  MessageStart start;
  start.channel = fields.number<std::uint16_t>();
  fields.number<std::uint32_t>();  // sequence
  start.log_time_ns = time_of(fields);
  fields.number<std::uint64_t>();  // publish time
  return start;
}

ChunkStart chunk_start(std::span<const std::byte> beginning) {
  WireReader fields = fields_of(beginning);
  ChunkStart start;
  start.first_ns = time_of(fields);
  start.last_ns = time_of(fields);
  start.uncompressed_bytes = fields.number<std::uint64_t>();
  start.crc = fields.number<std::uint32_t>();
  start.compression = fields.text();
  start.compressed_bytes = fields.number<std::uint64_t>();
  start.bytes = beginning.size() - fields.remaining();
  return start;
}

std::map<std::uint16_t, std::uint64_t> messages_of_channels(std::span<const std::byte> statistics) {
  WireReader fields = fields_of(statistics);
  fields.skip<std::byte>(8 + 2 + 4 * 4 + 8 + 8);  // totals, first and last time
  WireReader entries = fields_of(fields.blob());
  std::map<std::uint16_t, std::uint64_t> counts;
  while (entries.remaining() > 0) {
    const auto channel = entries.number<std::uint16_t>();
    counts[channel] = entries.number<std::uint64_t>();
  }
  return counts;
}

}  // namespace cmap::mcap
