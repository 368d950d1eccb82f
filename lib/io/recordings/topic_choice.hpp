#pragma once

#include <array>
#include <optional>

#include "cmap/io/recording.hpp"
#include "recordings/containers/message_store.hpp"
#include "recordings/messages/message_kind.hpp"

namespace cmap {

/// The topic of each role, as its number in the store; none: not read.
using TopicOfRole = std::array<std::optional<std::size_t>, kRecordingRoles>;

/// By name where options say one, else the only one of the kind that has a message. Throws InputError that lists what
/// is there; `name` is the recording.
TopicOfRole choose_topics(const std::vector<StoredTopic>& topics, const RecordingOptions& options,
                          const std::string& name);

/// The number of a topic. Throws InputError that lists what is there.
std::size_t topic_of_name(const std::vector<StoredTopic>& topics, const std::string& topic, const std::string& name);

/// By name, with what each can be for.
std::vector<RecordingTopic> listed_topics(const std::vector<StoredTopic>& topics);

/// What is understood of a topic: by type and encoding.
std::optional<MessageKind> kind_of(const StoredTopic& topic);

}  // namespace cmap
