#pragma once

#include <string>

#include "cmap/io/capture.hpp"

namespace cmap {

/// What capture.json holds.
struct CaptureDescription {
  CaptureCalibration calibration;
  double acceleration_unit_mps2 = 1.0;
  std::vector<Warning> warnings;
};

/// Reads the text of a capture.json; `source` names it in messages. Throws InputError as open_capture does, or puts
/// what is wrong with each part into `faults`. Who needs no camera reads one of a LiDAR alone.
CaptureDescription parse_capture_json(const std::string& text, const std::string& source, const Faults& faults = {},
                                      bool needs_camera = true);

/// The text that reads back as the same calibration; accelerations in m/s^2.
std::string capture_json(const CaptureCalibration& calibration);

}  // namespace cmap
