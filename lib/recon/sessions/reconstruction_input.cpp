#include "cmap/recon/reconstruction_input.hpp"

#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"

namespace cmap {

ReconstructionInput open_reconstruction_input(const std::filesystem::path& folder, const ReconstructionOptions& options,
                                              Stage last, const Execution& execution) {
  CaptureParts parts = parts_needed(options, last);
  const bool has_poses = is_there(folder / "lio.tum");
  if (!has_poses) {
    parts.scans = Want::kYes;
    parts.imu = Want::kIfUsable;
  }
  ReconstructionInput input{open_capture(folder, parts), std::nullopt};
  if (has_poses) return input;
  Capture& capture = input.capture;
  MappingOptions mapping;
  mapping.odometry.use_imu = !capture.imu.empty();
  const LidarMessages messages = capture_messages(capture, capture.warnings);
  const double duration_s = capture.scans.back().time_s - capture.scans.front().time_s;
  input.odometry =
      map_lidar(messages, capture.calibration, mapping, {.duration_s = duration_s, .scan = {}, .execution = execution});
  if (input.odometry->broken_off) throw InputError(*input.odometry->broken_off);
  capture.lio = input.odometry->imu_stamps;
  capture.warnings.insert(capture.warnings.end(), input.odometry->warnings.begin(), input.odometry->warnings.end());
  input.odometry->keyframes.clear();
  input.odometry->map = {};
  return input;
}

}  // namespace cmap
