#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "cmap/core/warning.hpp"
#include "cmap/geometry/rgb_image.hpp"
#include "cmap/io/recording.hpp"

namespace cmap {

/// A part of a recording, by arrival times from its first message that is read.
struct RecordingPart {
  double start_s = 0.0;
  std::optional<double> duration_s;  ///< none: to the end
};

struct UnpackedRecording {
  std::size_t scans = 0, images = 0, imu_samples = 0, poses = 0;
  std::vector<Warning> warnings;  ///< what was left out, and what the recording says
};

/// Makes a capture of a recording: scans, images (JPEG and PNG as they are, raw pixels as PNG), IMU by time in m/s^2,
/// and lio.tum where odometry is wanted, whose poses must be world_T_imu. Left out, with warnings: scans
/// without points, what does not come after the one before. Throws as Recording does, OutputError, and InputError where
/// there is nothing to write. Reports progress.
UnpackedRecording unpack_recording(const std::filesystem::path& recording, const RecordingConfiguration& configuration,
                                   const std::filesystem::path& capture, const RecordingPart& part = {});

/// The pixels of an image that is not compressed: rgb8, bgr8, rgba8, bgra8, mono8, mono16 (its high byte), their names
/// of OpenCV (8UC1, 8UC3 as bgr8, 16UC1), and bayer_*8, whose missing colors are the mean of their neighbors. Throws
/// UnsupportedError for others, InputError where rows are too short.
RgbImage rgb_of_raw(const RecordedImage& image);

}  // namespace cmap
