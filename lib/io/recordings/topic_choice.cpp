#include "recordings/topic_choice.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

/// "/imu (sensor_msgs/Imu, 200 messages)", by name.
std::string list_of(std::vector<StoredTopic> topics) {
  if (topics.empty()) return "nothing";
  std::ranges::sort(topics, {}, &StoredTopic::name);
  std::vector<std::string> lines;
  for (const StoredTopic& topic : topics) {
    const bool is_known = topic.encoding() != MessageEncoding::kOther;
    lines.push_back(fmt::format("{} ({}{}, {} messages)", topic.name, short_type_name(topic.type),
                                is_known ? "" : " as " + topic.encoding_name, topic.n_messages));
  }
  return fmt::format("{}", fmt::join(lines, ", "));
}

bool is_of(const StoredTopic& topic, RecordingRole role) {
  const std::optional<MessageKind> kind = kind_of(topic);
  return kind && role_of(*kind) == role;
}

std::size_t named_topic(const std::vector<StoredTopic>& topics, const std::string& topic, RecordingRole role,
                        const std::string& name) {
  const std::size_t found = topic_of_name(topics, topic, name);
  if (is_of(topics[found], role)) return found;
  throw InputError(fmt::format("{}: topic {} holds {} ({}), which cannot be read as {}", name, topic,
                               short_type_name(topics[found].type), topics[found].encoding_name,
                               name_of(role, recording_role_names())));
}

}  // namespace

std::optional<MessageKind> kind_of(const StoredTopic& topic) {
  if (topic.encoding() == MessageEncoding::kOther) return std::nullopt;
  return message_kind(short_type_name(topic.type));
}

std::size_t topic_of_name(const std::vector<StoredTopic>& topics, const std::string& topic, const std::string& name) {
  const auto found = std::ranges::find(topics, topic, &StoredTopic::name);
  if (found == topics.end())
    throw InputError(fmt::format("{}: no topic {}; there is {}", name, topic, list_of(topics)));
  return static_cast<std::size_t>(found - topics.begin());
}

TopicOfRole choose_topics(const std::vector<StoredTopic>& topics, const RecordingOptions& options,
                          const std::string& name) {
  TopicOfRole chosen;
  for (const auto& [role, role_name] : recording_role_names()) {
    const RecordingSource& source = options.source(role);
    std::optional<std::size_t>& place = chosen[static_cast<std::size_t>(role)];
    if (source.want == Want::kNo) continue;
    if (!source.topic.empty()) {
      place = named_topic(topics, source.topic, role, name);
      continue;
    }
    std::vector<StoredTopic> candidates;
    for (std::size_t i = 0; i < topics.size(); ++i) {
      if (topics[i].n_messages == 0 || !is_of(topics[i], role)) continue;
      candidates.push_back(topics[i]);
      place = i;
    }
    if (candidates.size() > 1) {
      throw InputError(fmt::format("{}: which topic is the {}'s (recording.topics)? There is {}", name, role_name,
                                   list_of(candidates)));
    }
    if (candidates.empty() && source.want == Want::kYes) {
      throw InputError(fmt::format("{}: no topic for the {}; there is {}", name, role_name, list_of(topics)));
    }
  }
  return chosen;
}

}  // namespace cmap
