#pragma once

#include "recordings/containers/message_store.hpp"

namespace cmap {

/// A bag of ROS 1 (version 2.0), by ROS' own library. Its index is needed: a bag without is an
/// error. Messages that arrived at time 0 are none to ROS, which says so on standard error.
std::unique_ptr<MessageStore> open_ros1_bag(const std::filesystem::path& path);

}  // namespace cmap
