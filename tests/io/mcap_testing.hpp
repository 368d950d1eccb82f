#pragma once

#include <zlib.h>

#include "io/io_testing.hpp"
#include "io/wire_testing.hpp"
#include "recordings/containers/message_store.hpp"
#include "recordings/mcap/mcap_store.hpp"

namespace cmap::testing {

/// Records of MCAP, put together by hand.
class McapText {
 public:
  McapText& record(std::uint8_t opcode, std::string_view body) {
    bytes_ += static_cast<char>(opcode);
    bytes_ += Bytes().put(static_cast<std::uint64_t>(body.size())).str();
    bytes_ += body;
    return *this;
  }
  McapText& header() { return record(1, WireWriter(Wire::kRos1).text("ros1").text("test").str()); }
  McapText& schema(std::uint16_t id, std::string_view type) {
    return record(3, WireWriter(Wire::kRos1).put(id).text(type).text("ros1msg").text("").str());
  }
  McapText& channel(std::uint16_t id, std::uint16_t schema, std::string_view topic,
                    std::string_view encoding = "ros1") {
    return record(4,
                  WireWriter(Wire::kRos1).put(id).put(schema).text(topic).text(encoding).put(std::uint32_t{0}).str());
  }
  McapText& message(std::uint16_t channel, std::uint64_t log_time_ns, std::string_view data) {
    const std::uint32_t sequence = 0;
    return record(5, Bytes().put(channel, sequence, log_time_ns, log_time_ns).text(data).str());
  }
  McapText& chunk(const McapText& records, std::uint64_t first_ns, std::uint64_t last_ns) {
    return chunk(records.str(), records.str().size(), crc(records.str()), "", first_ns, last_ns);
  }
  McapText& chunk(std::string_view packed, std::uint64_t unpacked_bytes, std::uint32_t its_crc,
                  std::string_view compression, std::uint64_t first_ns, std::uint64_t last_ns) {
    WireWriter body(Wire::kRos1);
    body.put(first_ns).put(last_ns).put(unpacked_bytes).put(its_crc).text(compression);
    body.put(static_cast<std::uint64_t>(packed.size())).raw(packed);
    return record(6, body.str());
  }
  /// The end of a file without a summary.
  McapText& end() {
    record(15, Bytes().put(std::uint32_t{0}).str());
    return record(2, Bytes().put(std::uint64_t{0}, std::uint64_t{0}, std::uint32_t{0}).str());
  }

  static std::uint32_t crc(std::string_view bytes) {
    return static_cast<std::uint32_t>(
        ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
  }
  const std::string& str() const { return bytes_; }
  static constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
  std::string file() const { return std::string(kMagic) + bytes_ + std::string(kMagic); }

 private:
  std::string bytes_;
};

/// Some bytes as a store; they must outlive it.
inline std::unique_ptr<MessageStore> mcap_of(const std::string& bytes) {
  return open_mcap(std::make_unique<ByteSource>("test.mcap", bytes_of(bytes)));
}

/// "topic@log time: data" of every message up to the end, or to what is wrong, which comes last.
inline std::vector<std::string> messages_of(MessageStore& store) {
  std::vector<std::string> messages;
  StoredMessage message;
  try {
    while (store.next(message)) {
      messages.push_back(
          fmt::format("{}@{}: {}", store.topics()[message.topic].name, message.log_time_ns,
                      std::string_view(reinterpret_cast<const char*>(message.data.data()), message.data.size())));
    }
  } catch (const Error& error) {
    messages.emplace_back(error.what());
  }
  return messages;
}

}  // namespace cmap::testing
