#pragma once

#include <filesystem>

#include "cmap/geometry/camera_model.hpp"
#include "cmap/geometry/rgb_image.hpp"

namespace cmap {

// Module cmap::images, apart from cmap::io: OpenCV's imgcodecs adds 64 ms to the start of whatever links it.

/// Reads a JPEG or PNG file (and what else OpenCV's imgcodecs decodes) as 8-bit RGB, as it lies in the file: an
/// orientation in its metadata is not applied, as calibrations are of the sensor. Thread-safe. Throws InputError naming
/// file and reason.
RgbImage read_image(const std::filesystem::path& path);

/// The same for an image of this camera. Throws InputError too if its size is not the calibration's.
RgbImage read_image(const std::filesystem::path& path, const CameraModel& camera);

/// Writes .jpg, .jpeg (quality 95) or .png; the file appears under its name only when complete. Throws UsageError for
/// another name, OutputError if it cannot be written, std::invalid_argument unless there are width * height > 0 pixels.
void write_image(const RgbImage& image, const std::filesystem::path& path);

}  // namespace cmap
