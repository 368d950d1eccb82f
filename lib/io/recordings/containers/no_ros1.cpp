#include "recordings/containers/ros1_store.hpp"

namespace cmap {

std::unique_ptr<MessageStore> open_ros1_bag(const std::filesystem::path& path) {
  throw UnsupportedError(path.string() +
                         ": a bag of ROS 1; this build of cmap cannot read it (apt-get install librosbag-storage-dev, "
                         "and build again)");
}

}  // namespace cmap
