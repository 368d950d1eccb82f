#pragma once

#include <filesystem>
#include <optional>

#include "cmap/core/execution.hpp"
#include "cmap/io/capture.hpp"
#include "cmap/lio/lidar_mapping.hpp"
#include "cmap/recon/reconstruction.hpp"

namespace cmap {

/// A capture as a run up to a stage reads it.
struct ReconstructionInput {
  Capture capture;
  std::optional<LidarMapping> odometry;  ///< where the capture has no lio.tum: what its poses are from; without points
};

/// Opens what the run needs. Where there is no lio.tum, odometry with loop closure runs over the scans, with the IMU if
/// there is one, and the capture's poses are those at the IMU's stamps, else at scans' ends. Reports progress. Throws
/// as open_capture() and map_lidar() do.
ReconstructionInput open_reconstruction_input(const std::filesystem::path& folder, const ReconstructionOptions& options,
                                              Stage last, const Execution& execution = {});

}  // namespace cmap
