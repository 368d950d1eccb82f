#include "cmap/recon/capture_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cmap/align/trajectory.hpp"
#include "cmap/core/error.hpp"
#include "cmap/io/lidar_scan.hpp"
#include "recon/session_check.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

/// What is there, and what is needed whether it is there or not.
CaptureParts parts_to_check(const fs::path& folder, const ReconstructionOptions& options, Stage last) {
  const CaptureParts needed = parts_needed(options, last);
  const auto want = [&](const char* table, Want need) {
    return need == Want::kYes || fs::exists(folder / table) ? Want::kYes : Want::kNo;
  };
  return {.images = want("images.csv", needed.images), .scans = want("lidar.csv", needed.scans), .imu = Want::kYes};
}

void check_needed(const Capture& capture, CaptureCheck& check) {
  const fs::path lio = capture.folder / "lio.tum", predictions = capture.folder / "predictions";
  if (!fs::exists(lio))
    check.faults.push_back(
        fmt::format("{}: no such file; LiDAR-inertial poses (world_T_imu) are needed", lio.string()));
  if (capture.sessions.empty()) {
    check.faults.push_back(
        fmt::format("{}: no sessions of predictions: folders, or NAME.npz with NAME.frames.csv", predictions.string()));
  }
}

void check_scans(const Capture& capture, const ReconstructionOptions& options, const ProgressSink& progress,
                 CaptureCheck& check) {
  const Faults faults(check.faults);
  std::size_t n_points = 0, n_placed = 0, i = 0;
  for (const StampedFile& file : capture.scans) {
    if (progress) progress("scans", static_cast<double>(i++) / static_cast<double>(capture.scans.size()));
    faults.attempt([&] { n_points += read_lidar_scan(file.path, file.time_s).positions.size(); });
    if (pose_at(capture.lio, file.time_s, options.prefusion.max_gap_s)) ++n_placed;
  }
  const std::string table = (capture.folder / "lidar.csv").string();
  const std::size_t n = capture.scans.size();
  if (n > 0 && n_points == 0) check.faults.push_back(fmt::format("{}: none of the {} scans has a point", table, n));
  if (n == 0 || capture.lio.empty() || n_placed == n) return;
  const std::string text = fmt::format(
      "{}: {} of {} scans have no LiDAR-inertial pose at their time: scans from {:.3f} to {:.3f} s, poses from {:.3f} "
      "to "
      "{:.3f} s, gaps of at most {:g} s (max_gap_s)",
      table, n - n_placed, n, capture.scans.front().time_s, capture.scans.back().time_s, capture.lio.front().time_s,
      capture.lio.back().time_s, options.prefusion.max_gap_s);
  (n_placed == 0 ? check.faults : check.warnings).push_back(text);
}

}  // namespace

CaptureCheck check_capture(const fs::path& folder, const ReconstructionOptions& options, Stage last,
                           const ProgressSink& progress) {
  CaptureCheck check;
  const Faults faults(check.faults);
  Capture capture;
  faults.attempt([&] { capture = open_capture(folder, parts_to_check(folder, options, last), faults); });
  if (capture.folder.empty()) return check;
  for (const Warning& warning : capture.warnings) check.warnings.push_back(warning.message);
  check_needed(capture, check);
  SessionCheck sessions(capture, options, check);
  for (std::size_t i = 0; i < capture.sessions.size(); ++i) {
    if (progress) progress("sessions", static_cast<double>(i) / static_cast<double>(capture.sessions.size()));
    sessions.add(i);
  }
  check_scans(capture, options, progress, check);
  check.summary = fmt::format("{} sessions of {} frames, {} poses, {} scans, {} pictures", capture.sessions.size(),
                              sessions.frames(), capture.lio.size(), capture.scans.size(), capture.images.size());
  return check;
}

}  // namespace cmap
