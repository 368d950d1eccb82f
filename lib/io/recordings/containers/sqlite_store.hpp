#pragma once

#include "recordings/containers/message_store.hpp"

namespace cmap {

/// An SQLite file with the tables of rosbag2 (topics, messages), of any of its versions.
std::unique_ptr<MessageStore> open_sqlite(const std::filesystem::path& path);

}  // namespace cmap
