#include <algorithm>

#include "recordings/topic_choice.hpp"

namespace cmap {

const EnumNames<RecordingRole>& recording_role_names() {
  static const EnumNames<RecordingRole> names{{RecordingRole::kLidar, "lidar"},
                                              {RecordingRole::kImu, "imu"},
                                              {RecordingRole::kImage, "image"},
                                              {RecordingRole::kOdometry, "odometry"}};
  return names;
}

const EnumNames<PointTimeUnit>& point_time_unit_names() {
  static const EnumNames<PointTimeUnit> names{{PointTimeUnit::kAuto, "auto"},
                                              {PointTimeUnit::kSeconds, "s"},
                                              {PointTimeUnit::kMilliseconds, "ms"},
                                              {PointTimeUnit::kMicroseconds, "us"},
                                              {PointTimeUnit::kNanoseconds, "ns"}};
  return names;
}

std::vector<RecordingTopic> recording_topics(const std::filesystem::path& path) {
  return listed_topics(open_message_store(path)->topics());
}

std::vector<RecordingTopic> listed_topics(const std::vector<StoredTopic>& stored) {
  std::vector<RecordingTopic> topics;
  for (const StoredTopic& topic : stored) {
    const std::optional<MessageKind> kind = kind_of(topic);
    topics.push_back({topic.name, short_type_name(topic.type), topic.encoding_name, topic.n_messages,
                      kind ? role_of(*kind) : std::nullopt});
  }
  std::ranges::sort(topics, {}, &RecordingTopic::name);
  return topics;
}

}  // namespace cmap
