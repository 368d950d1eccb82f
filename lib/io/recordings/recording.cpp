#include "cmap/io/recording.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cmap/core/error.hpp"
#include "recordings/acceleration_unit.hpp"
#include "recordings/containers/unpack_zstd.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/time_references.hpp"
#include "recordings/topic_choice.hpp"

namespace cmap {
namespace fs = std::filesystem;

struct Recording::State {
  /// What is read of a topic.
  struct Reader {
    MessageDecoder decoder;
    std::optional<TimeReferences> references = {};
    std::uint64_t n_without_reference = 0;
  };

  State(const fs::path& recording, const RecordingOptions& options)
      : path(recording), store(open_message_store(recording)), topics(listed_topics(store->topics())) {
    const std::vector<StoredTopic>& stored = store->topics();
    const TopicOfRole chosen = choose_topics(stored, options, path.string());
    std::vector<bool> is_wanted(stored.size(), false);
    readers.resize(stored.size());
    for (std::size_t role = 0; role < kRecordingRoles; ++role) {
      if (!chosen[role]) continue;
      const StoredTopic& topic = stored[*chosen[role]];
      is_wanted[*chosen[role]] = true;
      topic_of[role] = topic.name;
      n_wanted += topic.n_messages;
      readers[*chosen[role]] = reader_of(topic, *chosen[role], static_cast<RecordingRole>(role), options);
    }
    store->select(is_wanted);
  }

  std::unique_ptr<Reader> reader_of(const StoredTopic& topic, std::size_t number, RecordingRole role,
                                    const RecordingOptions& options) {
    if (role == RecordingRole::kImu) {
      is_in_g = options.acceleration_unit == AccelerationUnit::kG ||
                (options.acceleration_unit == AccelerationUnit::kAuto && cmap::has_acceleration_in_g(path, number));
    }
    auto reader = std::make_unique<Reader>(Reader{MessageDecoder(
        kind_of(topic).value(), topic.encoding(), options.point_time_unit, is_in_g ? kStandardGravity_mps2 : 1.0)});
    const std::string& references = options.source(role).time_reference;
    if (!references.empty()) reader->references.emplace(path, references);
    return reader;
  }

  /// None: its time is not known.
  std::optional<RecordedMessage> decode(Reader& reader, const StoredMessage& message) {
    try {
      const bool is_cdr = store->topics()[message.topic].encoding() == MessageEncoding::kCdr;
      const std::span<const std::byte> sent = is_cdr ? sent_message(message.data, room) : message.data;
      std::optional<std::int64_t> stamp_ns;
      if (reader.references) {
        stamp_ns = reader.references->time_ns(reader.decoder.sequence(sent));
        if (!stamp_ns) {
          ++reader.n_without_reference;
          return std::nullopt;
        }
      }
      return reader.decoder.decode(sent, stamp_ns);
    } catch (const UnsupportedError& error) {
      throw UnsupportedError(named(message) + error.what());
    } catch (const InputError& error) {
      throw InputError(named(message) + error.what());
    }
  }

  std::string named(const StoredMessage& message) const {
    const StoredTopic& topic = store->topics()[message.topic];
    return fmt::format("{}, topic {} ({}): ", store->place(), topic.name, short_type_name(topic.type));
  }

  fs::path path;
  std::unique_ptr<MessageStore> store;
  std::vector<RecordingTopic> topics;
  std::array<std::string, kRecordingRoles> topic_of;
  std::vector<std::unique_ptr<Reader>> readers;  ///< by the store's number of the topic; null: not read
  bool is_in_g = false;
  std::uint64_t n_wanted = 0, n_read = 0;
  double arrival_time_s = 0.0;
  Array<std::byte> room;  ///< for messages that are packed
};

Recording::Recording(const fs::path& path, const RecordingOptions& options)
    : state_(std::make_unique<State>(path, options)) {}
Recording::~Recording() = default;
Recording::Recording(Recording&&) noexcept = default;
Recording& Recording::operator=(Recording&&) noexcept = default;

const std::vector<RecordingTopic>& Recording::topics() const { return state_->topics; }
const std::string& Recording::topic_of(RecordingRole role) const {
  return state_->topic_of[static_cast<std::size_t>(role)];
}
bool Recording::has_acceleration_in_g() const { return state_->is_in_g; }
double Recording::arrival_time_s() const { return state_->arrival_time_s; }

double Recording::done() const {
  if (state_->n_wanted == 0) return 1.0;
  return std::min(1.0, static_cast<double>(state_->n_read) / static_cast<double>(state_->n_wanted));
}

std::optional<RecordedMessage> Recording::next() {
  StoredMessage message;
  while (state_->store->next(message)) {
    ++state_->n_read;
    state_->arrival_time_s = 1e-9 * static_cast<double>(message.log_time_ns);
    std::optional<RecordedMessage> decoded = state_->decode(*state_->readers[message.topic], message);
    if (decoded) return decoded;
  }
  return std::nullopt;
}

std::vector<Warning> Recording::warnings() const {
  std::vector<Warning> warnings;
  for (std::size_t i = 0; i < state_->readers.size(); ++i) {
    const auto& reader = state_->readers[i];
    if (!reader || reader->n_without_reference == 0) continue;
    warnings.push_back(
        {"no_time_reference",
         fmt::format("{}: {} messages of {} have no time reference and were left out", state_->path.string(),
                     reader->n_without_reference, state_->store->topics()[i].name)});
  }
  return warnings;
}

}  // namespace cmap
