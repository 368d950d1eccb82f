#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "recordings/wire/wire_reader.hpp"

namespace cmap {

struct StoredTopic {
  std::string name;
  std::string type;           ///< as it is written
  std::string encoding_name;  ///< of messages
  std::uint64_t n_messages = 0;

  MessageEncoding encoding() const {
    if (encoding_name == "ros1") return MessageEncoding::kRos1;
    return encoding_name == "cdr" ? MessageEncoding::kCdr : MessageEncoding::kOther;
  }
};

struct StoredMessage {
  std::size_t topic = 0;
  std::int64_t log_time_ns = 0;     ///< when it arrived
  std::span<const std::byte> data;  ///< until the next one is taken
};

/// The messages of a recording's file or files, whatever they hold. Throws InputError naming file, place and reason.
class MessageStore {
 public:
  virtual ~MessageStore() = default;

  /// In no order, each name once.
  virtual const std::vector<StoredTopic>& topics() const = 0;
  /// Which topics' messages next() gives, before its first call; otherwise all.
  virtual void select(const std::vector<bool>& is_wanted) = 0;
  /// By log time, those of equal times as they stand in the file; false at the end.
  virtual bool next(StoredMessage& message) = 0;
  /// Where the last message is: "drive.mcap: byte 123".
  virtual std::string place() const = 0;
};

/// Recognized by content, as is_recording() does. Throws InputError for anything else.
std::unique_ptr<MessageStore> open_message_store(const std::filesystem::path& path);

}  // namespace cmap
