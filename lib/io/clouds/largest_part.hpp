#pragma once

#include <cstddef>
#include <span>

#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// The place of the largest part of a file (the first of equal ones), as others may lie in frames of their own: warns
/// where these hold points, calling them `parts` ("models"). `sizes`, points of each part, must not be empty.
std::size_t largest_part(std::span<const std::size_t> sizes, const char* parts, FileInfo& info);

}  // namespace cmap
