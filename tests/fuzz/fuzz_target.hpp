#pragma once

#include <Eigen/LU>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "cmap/core/error.hpp"
#include "io/capture_json.hpp"
#include "io/file_format.hpp"
#include "io/format_readers.hpp"
#include "io/session_arrays.hpp"
#include "io/trajectory_rows.hpp"
#include "io/transform_numbers.hpp"

namespace cmap::fuzz {

using Reader = PointCloud (*)(ByteSource&, FileInfo&);

/// Whatever the content says it is.
inline PointCloud read_any(ByteSource& source, FileInfo& info) { return detect_format(source).read(source, info, {}); }
