#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "cmap/io/recording.hpp"

namespace cmap {

/// The types of messages that are understood.
enum class MessageKind {
  kPointCloud2,
  kLivoxCustom,
  kVelodyneScan,
  kImu,
  kImage,
  kCompressedImage,
  kOdometry,
  kTimeReference
};

/// "sensor_msgs/Imu" of "sensor_msgs/msg/Imu".
std::string short_type_name(std::string_view type);

/// Of a short name; none: stepped over.
std::optional<MessageKind> message_kind(std::string_view short_name);

/// What messages of a kind are for; none: a time reference.
std::optional<RecordingRole> role_of(MessageKind kind);

}  // namespace cmap
