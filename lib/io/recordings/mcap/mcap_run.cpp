#include "recordings/mcap/mcap_run.hpp"

#include <algorithm>

#include "recordings/mcap/mcap_chunk.hpp"

namespace cmap::mcap {
namespace {

void read_whole(const ByteSource& source, std::uint64_t begin, std::uint64_t end, Array<std::byte>& bytes) {
  bytes.clear();
  bytes.resize(end - begin);
  if (source.read_at(begin, bytes) != bytes.size()) source.fail("became shorter while it was read");
}

}  // namespace

void OpenRun::open(const ByteSource& source, const Run& run, Channels& channels) {
  run_ = run;
  entries_.clear();
  next_ = 0;
  unpacked_.clear();
  const char* kind = run.is_chunk ? "chunk" : "messages";
  try {
    if (run.is_chunk) {
      read_whole(source, run.begin + kRecordStart, run.end, packed_);
      const ChunkStart start = chunk_start(packed_);
      const std::size_t left = packed_.size() - start.bytes;
      if (start.compressed_bytes > left) {
        throw InputError(fmt::format("{} compressed bytes, but {} are left", start.compressed_bytes, left));
      }
      take(unpack_chunk(start, std::span(packed_).subspan(start.bytes, start.compressed_bytes), unpacked_), channels);
    } else {
      read_whole(source, run.begin, run.end, packed_);
      take(packed_, channels);
    }
  } catch (const UnsupportedError& error) {
    throw UnsupportedError(fmt::format("{}: the {} at byte {}: {}", source.name(), kind, run.begin, error.what()));
  } catch (const InputError& error) {
    source.fail("the {} at byte {}: {}", kind, run.begin, error.what());
  }
}

void OpenRun::take(std::span<const std::byte> records, Channels& channels) {
  for_each_record(records, [&](std::uint8_t opcode, std::span<const std::byte> body, std::size_t place) {
    if (opcode == kSchema) {
      channels.add_schema(body);
    } else if (opcode == kChannel) {
      channels.add_channel(body);
    } else if (opcode == kMessage) {
      const MessageStart start = message_start(body);
      if (!channels.by_id.contains(start.channel)) {
        throw InputError(fmt::format("a message of channel {}, which was not declared", start.channel));
      }
      entries_.push_back({start.log_time_ns, place, start.channel, body.subspan(kMessageStart)});
    }
  });
  std::ranges::stable_sort(entries_, {}, &Entry::log_time_ns);
}

}  // namespace cmap::mcap
