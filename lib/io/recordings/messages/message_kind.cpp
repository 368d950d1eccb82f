#include "recordings/messages/message_kind.hpp"

#include <array>
#include <utility>

namespace cmap {
namespace {

constexpr std::array<std::pair<std::string_view, MessageKind>, 10> kKinds{{
    {"sensor_msgs/PointCloud2", MessageKind::kPointCloud2},
    {"livox_ros_driver/CustomMsg", MessageKind::kLivoxCustom},
    {"livox_ros_driver2/CustomMsg", MessageKind::kLivoxCustom},
    {"livox_interfaces/CustomMsg", MessageKind::kLivoxCustom},
    {"velodyne_msgs/VelodyneScan", MessageKind::kVelodyneScan},
    {"sensor_msgs/Imu", MessageKind::kImu},
    {"sensor_msgs/Image", MessageKind::kImage},
    {"sensor_msgs/CompressedImage", MessageKind::kCompressedImage},
    {"nav_msgs/Odometry", MessageKind::kOdometry},
    {"sensor_msgs/TimeReference", MessageKind::kTimeReference},
}};

}  // namespace

std::string short_type_name(std::string_view type) {
  constexpr std::string_view kMiddle = "/msg/";
  const std::size_t place = type.find(kMiddle);
  if (place == std::string_view::npos) return std::string(type);
  return std::string(type.substr(0, place)) + "/" + std::string(type.substr(place + kMiddle.size()));
}

std::optional<MessageKind> message_kind(std::string_view short_name) {
  for (const auto& [name, kind] : kKinds) {
    if (name == short_name) return kind;
  }
  return std::nullopt;
}

std::optional<RecordingRole> role_of(MessageKind kind) {
  switch (kind) {
    case MessageKind::kPointCloud2:
    case MessageKind::kLivoxCustom:
    case MessageKind::kVelodyneScan:
      return RecordingRole::kLidar;
    case MessageKind::kImu:
      return RecordingRole::kImu;
    case MessageKind::kImage:
    case MessageKind::kCompressedImage:
      return RecordingRole::kImage;
    case MessageKind::kOdometry:
      return RecordingRole::kOdometry;
    case MessageKind::kTimeReference:
      break;
  }
  return std::nullopt;
}

}  // namespace cmap
