#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cmap {

/// What a metadata.yaml of rosbag2 says that one must know to read the files.
struct Rosbag2Metadata {
  std::vector<std::filesystem::path> files;            ///< in their order, ready to open
  std::string storage, compression, compression_mode;  ///< empty: not said
};

/// Reads the lines that matter of what rosbag2 and rosbags write, versions 1 to 9. Throws InputError naming file and
/// reason: without a list of files, a file that is not there.
Rosbag2Metadata read_rosbag2_metadata(const std::filesystem::path& path);

}  // namespace cmap
