#pragma once

#include <span>
#include <string>
#include <string_view>

#include "bytes/file_start.hpp"
#include "cmap/io/byte_source.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// A format of point clouds: a source NAME_reader.cpp that defines `formats::NAME`, and its line in CMakeLists.txt.
struct CloudFormat {
  std::string_view name;         ///< for messages
  std::string_view listed = {};  ///< among what can be read, for people; empty: with another format
  bool (*by_content)(const FileStart& start) = nullptr;  ///< null where only its name tells it
  bool (*by_name)(const FileStart& start) = nullptr;     ///< asked where no content tells; null: never
  /// Reads from the first byte of the source on; fills in format, counts and notes of `info`.
  PointCloud (*read)(ByteSource& source, FileInfo& info, const ReadOptions& options) = nullptr;
  bool has_classes = false;  ///< ReadOptions::classes can be chosen from
};

/// For CloudFormat::read, of a reader that has no options.
template <auto reader>
PointCloud without_options(ByteSource& source, FileInfo& info, const ReadOptions&) {
  return reader(source, info);
}

/// All formats in the order in which they are tried.
std::span<const CloudFormat* const> cloud_formats();

/// The format of a point cloud, by content first and by the extension of the name second. Throws InputError for
/// anything else, naming what it is where that can be told, and what can be read.
const CloudFormat& detect_format(ByteSource& source);

/// What read_point_cloud() does, on a source that is already open.
PointCloudFile read_point_cloud(ByteSource& source, const ReadOptions& options = {});

}  // namespace cmap
