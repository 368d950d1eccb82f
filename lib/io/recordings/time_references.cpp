#include "recordings/time_references.hpp"

#include "recordings/messages/small_messages.hpp"
#include "recordings/topic_choice.hpp"

namespace cmap {

TimeReferences::TimeReferences(const std::filesystem::path& recording, const std::string& topic) {
  const std::unique_ptr<MessageStore> store = open_message_store(recording);
  const std::vector<StoredTopic>& topics = store->topics();
  const std::size_t number = topic_of_name(topics, topic, recording.string());
  if (kind_of(topics[number]) != MessageKind::kTimeReference) {
    throw InputError(fmt::format("{}: topic {} holds {}; sensor_msgs/TimeReference expected", recording.string(), topic,
                                 short_type_name(topics[number].type)));
  }
  if (topics[number].encoding() != MessageEncoding::kRos1) {
    throw InputError(fmt::format("{}: topic {}: time references go by sequence numbers, which ROS 2 does not have",
                                 recording.string(), topic));
  }
  std::vector<bool> is_wanted(topics.size(), false);
  is_wanted[number] = true;
  store->select(is_wanted);
  StoredMessage message;
  while (store->next(message)) {
    WireReader reader(MessageEncoding::kRos1, message.data);
    try {
      const TimeReference reference = read_time_reference_message(reader);
      time_of_.emplace(reference.header.sequence, reference.reference_ns);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}: {}", store->place(), topic, error.what()));
    }
  }
}

std::optional<std::int64_t> TimeReferences::time_ns(std::uint32_t sequence) const {
  const auto found = time_of_.find(sequence);
  return found == time_of_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace cmap
