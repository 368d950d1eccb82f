#pragma once

#include "io/byte_source.hpp"

namespace cmap {

enum class FileFormat { kPly, kPcd, kLas, kNpy, kNpz, kText };

/// The format of a point cloud, by content first and by the extension of the name second. Throws InputError for
/// anything else, naming what it is where that can be told, and what can be read.
FileFormat detect_format(ByteSource& source);

}  // namespace cmap
