#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cmap/recon/reconstruction.hpp"

namespace cmap {

/// What is missing in a capture or odd about it. Each text names file, place and reason.
struct CaptureCheck {
  std::vector<std::string> faults;    ///< a reconstruction would end there or do without what it needs, or files
                                      ///< contradict
  std::vector<std::string> warnings;  ///< a reconstruction would go on
  std::string summary;                ///< what the capture holds
};

/// Reads everything that a capture holds, goes on after each fault, and compares the parts with each other: times of
/// frames, scans and pictures with those of the poses, poses of sessions with odometry. Parts that a run with these
/// options up to this stage does not need may be missing; those that are there are read all the same, and what is wrong
/// with them is a warning. Writes nothing.
CaptureCheck check_capture(const std::filesystem::path& folder, const ReconstructionOptions& options, Stage last,
                           const Execution& execution = {});

}  // namespace cmap
