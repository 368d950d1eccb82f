#pragma once

#include <string_view>

#include "bytes/file_start.hpp"
#include "cmap/io/byte_source.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// A format of point clouds: one line in the table of file_format.cpp.
struct CloudFormat {
  std::string_view name;
  bool (*recognizes)(const FileStart& start);
  PointCloud (*read)(ByteSource& source, FileInfo& info, const ReadOptions& options);
  bool has_classes = false;  ///< ReadOptions::classes can be chosen from
};

/// The format of a point cloud, by content first and by the extension of the name second. Throws InputError for
/// anything else, naming what it is where that can be told, and what can be read.
const CloudFormat& detect_format(ByteSource& source);

}  // namespace cmap
