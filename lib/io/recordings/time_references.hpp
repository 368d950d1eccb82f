#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>

#include "recordings/wire/wire_reader.hpp"

namespace cmap {

/// What a topic of sensor_msgs/TimeReference says each sequence number's time is. All of it is read at once: a message
/// may come before its reference.
class TimeReferences {
 public:
  /// Throws InputError where the topic is not there, is of another type, or of ROS 2, which has no sequence numbers.
  TimeReferences(const std::filesystem::path& recording, const std::string& topic);

  /// None: no reference has this number.
  std::optional<std::int64_t> time_ns(std::uint32_t sequence) const;

 private:
  std::unordered_map<std::uint32_t, std::int64_t> time_of_;
};

}  // namespace cmap
