#pragma once

#include <filesystem>

#include "cmap/geometry/rgb_image.hpp"

namespace cmap {

/// Writes a PNG of 8-bit RGB, quickly rather than small; without OpenCV, which is no part of this library. Throws
/// OutputError.
void write_png(const RgbImage& image, const std::filesystem::path& path);

}  // namespace cmap
