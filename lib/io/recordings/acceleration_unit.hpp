#pragma once

#include <filesystem>

#include "recordings/containers/message_store.hpp"

namespace cmap {

/// Whether the accelerations of a topic of sensor_msgs/Imu are in g: the mean length of the first 200 is below 3, which
/// is between 1 and 9.8 in ratio, and which no craft's mean comes near.
bool has_acceleration_in_g(const std::filesystem::path& recording, std::size_t topic);

}  // namespace cmap
