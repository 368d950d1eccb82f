#include "cmap/recon/capture_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "check/session_check.hpp"
#include "cmap/align/trajectory.hpp"
#include "cmap/core/error.hpp"
#include "cmap/io/lidar_scan_file.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

/// What a run reads, and all else that is there.
CaptureParts parts_to_check(const CaptureParts& needed) {
  const auto want = [](Want need) { return need == Want::kYes ? Want::kYes : Want::kIfUsable; };
  return {.images = want(needed.images), .scans = want(needed.scans), .imu = want(needed.imu)};
}

void check_needed(const Capture& capture, CaptureCheck& check) {
  const std::string lio = (capture.folder / "lio.tum").string();
  const std::string predictions = (capture.folder / "predictions").string();
  if (!fs::exists(lio)) check.faults.push_back(lio + ": no such file; LiDAR-inertial poses (world_T_imu) are needed");
  if (!capture.sessions.empty()) return;
  check.faults.push_back(predictions + ": no sessions of predictions: folders, or NAME.npz with NAME.frames.csv");
}

/// The scans that have a pose at their time. That none has one ends a run only where it needs them.
void check_scan_times(const Capture& capture, double max_gap_s, bool needed, CaptureCheck& check) {
  const std::vector<StampedFile>& scans = capture.scans;
  const Trajectory& poses = capture.lio;
  if (scans.empty() || poses.empty()) return;
  const auto n_missing = std::ranges::count_if(
      scans, [&](const StampedFile& scan) { return !pose_at(poses, scan.time_s, max_gap_s).has_value(); });
  if (n_missing == 0) return;
  const bool is_fault = needed && n_missing == std::ssize(scans);
  (is_fault ? check.faults : check.warnings)
      .push_back(fmt::format("{}: {} of {} scans have no LiDAR-inertial pose at their time: {} (max_gap_s)",
                             (capture.folder / "lidar.csv").string(), n_missing, scans.size(),
                             times_of_scans_and_poses(capture, max_gap_s)));
}

void check_scans(const Capture& capture, std::vector<std::string>& list) {
  const Faults faults(list);
  std::size_t n_read = 0, n_points = 0, i = 0;
  for (const StampedFile& file : capture.scans) {
    report_progress("scans", static_cast<double>(i++) / static_cast<double>(capture.scans.size()));
    faults.attempt([&] {
      n_points += read_lidar_scan(file.path, file.time_s).positions.size();
      ++n_read;
    });
  }
  if (n_read == 0 || n_points > 0) return;
  list.push_back(fmt::format("{}: none of the {} scans has a point", (capture.folder / "lidar.csv").string(), n_read));
}

}  // namespace

CaptureCheck check_capture(const fs::path& folder, const ReconstructionOptions& options, Stage last,
                           const Execution& execution) {
  const ExecutionScope scope(execution);
  CaptureCheck check;
  const Faults faults(check.faults);
  Capture capture;
  const CaptureParts needed = parts_needed(options, last);
  faults.attempt([&] { capture = open_capture(folder, parts_to_check(needed), faults); });
  if (capture.folder.empty()) return check;
  for (const Warning& warning : capture.warnings) check.warnings.push_back(warning.message);
  check_needed(capture, check);
  SessionCheck sessions(capture, options, check);
  for (std::size_t i = 0; i < capture.sessions.size(); ++i) {
    report_progress("sessions", static_cast<double>(i) / static_cast<double>(capture.sessions.size()));
    sessions.add(i);
  }
  const bool needs_scans = needed.scans == Want::kYes;
  check_scan_times(capture, options.input.max_gap_s, needs_scans, check);
  check_scans(capture, needs_scans ? check.faults : check.warnings);
  check.summary = fmt::format("{} sessions of {} frames, {} poses, {} scans, {} pictures", capture.sessions.size(),
                              sessions.frames(), capture.lio.size(), capture.scans.size(), capture.images.size());
  return check;
}

}  // namespace cmap
