#include "recordings/mcap/mcap_layout.hpp"

#include "cmap/core/execution.hpp"
#include "recordings/mcap/file_window.hpp"

namespace cmap::mcap {
namespace {

/// A record of the file, its body not yet read.
struct Record {
  std::uint64_t place = 0, length = 0;
  std::uint8_t opcode = 0;
  std::uint64_t end() const { return place + kRecordStart + length; }
};

class LayoutReader {
 public:
  explicit LayoutReader(const ByteSource& source) : source_(source), window_(source) {}

  Layout read() {
    const std::span<const std::byte> magic = window_.look(0, kMagic.size());
    if (std::string_view(reinterpret_cast<const char*>(magic.data()), magic.size()) != kMagic) {
      source_.fail("is no MCAP file");
    }
    std::uint64_t place = kMagic.size();
    while (std::optional<Record> record = record_at(place)) {
      take(*record);
      place = record->end();
      if (record->opcode == kFooter) {
        check_end(place);
        break;
      }
    }
    return std::move(layout_);
  }

 private:
  std::optional<Record> record_at(std::uint64_t place) {
    throw_if_stopped();
    const std::span<const std::byte> start = window_.look(place, kRecordStart);
    if (start.size() < kRecordStart) {
      layout_.fault = fmt::format("truncated: the file ends at byte {} without a footer", source_.size());
      return std::nullopt;
    }
    WireReader fields(MessageEncoding::kRos1, start);
    Record record{place, 0, fields.number<std::uint8_t>()};
    record.length = fields.number<std::uint64_t>();
    if (record.opcode == 0) {
      layout_.fault = fmt::format("byte {}: a record of kind 0, which there is none of", place);
      return std::nullopt;
    }
    if (record.length > source_.size() - place - kRecordStart) {
      layout_.fault = fmt::format("truncated: the record at byte {} takes {} bytes, but the file ends at byte {}",
                                  place, record.length, source_.size());
      return std::nullopt;
    }
    return record;
  }

  std::span<const std::byte> body(const Record& record, std::uint64_t most) {
    return window_.look(record.place + kRecordStart, std::min(record.length, most));
  }

  void take(const Record& record) {
    constexpr std::uint64_t kMostOfDescription = std::uint64_t{1} << 26, kMostOfChunkStart = 128;
    try {
      switch (record.opcode) {
        case kSchema:
          return layout_.channels.add_schema(body(record, kMostOfDescription));
        case kChannel:
          return layout_.channels.add_channel(body(record, kMostOfDescription));
        case kMessage:
          return add_message(record, message_start(body(record, kMessageStart)));
        case kChunk:
          return add_chunk(record, chunk_start(body(record, kMostOfChunkStart)));
        case kStatistics:
          layout_.statistics = messages_of_channels(body(record, kMostOfDescription));
          return;
        case kDataEnd:
          return check_data(record);
        case kFooter:
          return check_summary(record);
        default:
          return;
      }
    } catch (const InputError& error) {
      source_.fail("the record at byte {}: {}", record.place, error.what());
    }
  }

  void add_message(const Record& record, const MessageStart& message) {
    constexpr std::uint64_t kRunBytes = std::uint64_t{1} << 20;
    is_all_covered_ = false;
    ++layout_.messages[message.channel];
    std::vector<Run>& runs = layout_.runs;
    if (runs.empty() || runs.back().is_chunk || runs.back().end - runs.back().begin > kRunBytes ||
        runs.back().end != record.place) {
      runs.push_back({record.place, record.end(), message.log_time_ns, message.log_time_ns, false});
    }
    Run& run = runs.back();
    run.end = record.end();
    run.first_ns = std::min(run.first_ns, message.log_time_ns);
    run.last_ns = std::max(run.last_ns, message.log_time_ns);
  }

  void add_chunk(const Record& record, const ChunkStart& chunk) {
    is_all_covered_ &= chunk.crc != 0;
    layout_.runs.push_back({record.place, record.end(), chunk.first_ns, chunk.last_ns, true});
  }

  void check_data(const Record& record) {
    data_end_ = record.end();
    const auto crc = WireReader(MessageEncoding::kRos1, body(record, 4)).number<std::uint32_t>();
    if (crc == 0 || is_all_covered_) return;
    const std::uint32_t found = crc_of_file(source_, 0, record.place);
    if (found != crc) fail_crc(crc, found, "all before");
  }

  /// A wrong summary spoils no message: what it says is not believed, and it is an error at the end.
  void check_summary(const Record& record) {
    WireReader footer(MessageEncoding::kRos1, body(record, kFooterBytes));
    footer.skip<std::byte>(16);
    const auto crc = footer.number<std::uint32_t>();
    if (crc == 0 || data_end_ == 0) return;
    const std::uint32_t found = crc_of_file(source_, data_end_, record.end() - 4);
    if (found == crc) return;
    layout_.statistics.reset();
    layout_.fault = fmt::format("the summary from byte {} on has checksum 0x{:08x}, but its bytes have 0x{:08x}",
                                data_end_, crc, found);
  }

  [[noreturn]] void fail_crc(std::uint32_t crc, std::uint32_t found, const char* what) {
    throw InputError(fmt::format("checksum 0x{:08x} of {}, but the bytes have 0x{:08x}", crc, what, found));
  }

  void check_end(std::uint64_t place) {
    const std::span<const std::byte> magic = window_.look(place, kMagic.size());
    if (std::string_view(reinterpret_cast<const char*>(magic.data()), magic.size()) == kMagic) return;
    if (layout_.fault.empty()) layout_.fault = fmt::format("truncated: no end mark at byte {}", place);
  }

  const ByteSource& source_;
  FileWindow window_;
  Layout layout_;
  std::uint64_t data_end_ = 0;
  bool is_all_covered_ = true;  ///< by checksums of chunks
};

}  // namespace

Layout read_layout(const ByteSource& source) { return LayoutReader(source).read(); }

}  // namespace cmap::mcap
