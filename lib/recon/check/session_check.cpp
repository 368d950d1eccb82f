#include "check/session_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/core/error.hpp"
#include "sessions/odometry.hpp"
#include "sessions/pose_convention.hpp"
#include "sessions/usable_predictions.hpp"

namespace cmap {
namespace {

void require_confident_pixels(const std::string& name, const SessionPredictions& session,
                              const ReconstructionOptions& options) {
  try {
    confidence_threshold(session, options.input.confidence, options.input.points);
  } catch (const Error& error) {
    throw InputError(fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace

SessionCheck::SessionCheck(const Capture& capture, const ReconstructionOptions& options, CaptureCheck& check)
    : capture_(capture), options_(options), check_(check) {
  for (const StampedFile& image : capture.images) image_times_s_[image.path.filename().string()] = image.time_s;
}

void SessionCheck::add(std::size_t index) {
  const std::string name = capture_.sessions[index].string();
  const Faults faults(check_.faults);
  const std::size_t n_before = check_.faults.size();
  SessionPredictions session;
  faults.attempt([&] { session = read_session(capture_, index, faults); });
  n_frames_ += session.frame_count();
  if (check_.faults.size() == n_before) {
    faults.attempt([&] {
      make_usable(name, options_.input.farthest_median_depths, session);
      require_confident_pixels(name, session, options_);
    });
  }
  for (const Warning& warning : session.warnings) check_.warnings.push_back(warning.message);
  if (session.frames.empty()) return;
  if (!capture_.lio.empty()) faults.attempt([&] { compare_with_poses(name, session); });
  faults.attempt([&] { compare_with_images(name, session); });
  const auto copy = seen_.add(name, times_of(session));
  if (copy) check_.faults.push_back(fmt::format("{}: {}", name, *copy));
  compare_with_scans(name, session);
}

void SessionCheck::compare_with_poses(const std::string& name, const SessionPredictions& session) {
  std::vector<double> times_s = times_of(session);
  std::ranges::sort(times_s);  // a faulty table may have them in any order
  const double max_gap_s = options_.input.max_gap_s;
  const OdometryPoses poses = odometry_poses(capture_, times_of(session), options_.input);
  const auto n_placed = std::ranges::count_if(poses, [](const auto& pose) { return pose.has_value(); });
  if (n_placed == 0) {
    throw InputError(fmt::format("{}: {}", name, no_common_time(times_s, capture_.lio, max_gap_s)));
  }
  if (n_placed < std::ssize(poses)) {
    check_.warnings.push_back(fmt::format("{}: {} of {} frames have no LiDAR-inertial pose within {:g} s (max_gap_s)",
                                          name, std::ssize(poses) - n_placed, poses.size(), max_gap_s));
  }
  if (session.T_camera_session.size() != poses.size()) return;
  require_pose_convention(name, session, poses, options_.input.convention);
}

/// Frames and pictures have one clock and one camera.
void SessionCheck::compare_with_images(const std::string& name, const SessionPredictions& session) {
  constexpr double kSame_s = 1e-3;
  for (const PredictionFrame& frame : session.frames) {
    const auto image = image_times_s_.find(frame.image_name);
    if (image == image_times_s_.end() || std::abs(image->second - frame.time_s) <= kSame_s) continue;
    throw InputError(fmt::format("{}: frame {}, {}, is at {:.3f} s, but images.csv has this picture at {:.3f} s", name,
                                 frame.index, frame.image_name, frame.time_s, image->second));
  }
  const CameraModel& camera = capture_.calibration.camera;
  const PredictionFrame& first = session.frames.front();
  if (camera.width > 0 && (first.original_width != camera.width || first.original_height != camera.height)) {
    check_.warnings.push_back(
        fmt::format("{}: its pictures were {} x {} pixels (orig_w, orig_h), but capture.json's camera has {} x {}",
                    name, first.original_width, first.original_height, camera.width, camera.height));
  }
  const bool is_known = std::ranges::any_of(
      session.frames, [&](const PredictionFrame& frame) { return image_times_s_.contains(frame.image_name); });
  if (is_known || image_times_s_.empty()) return;
  check_.warnings.push_back(fmt::format("{}: none of its pictures is in images.csv", name));
}

void SessionCheck::compare_with_scans(const std::string& name, const SessionPredictions& session) {
  if (capture_.scans.empty()) return;
  const double first_s = session.frames.front().time_s - options_.registration.lidar.margin_s;
  const double last_s = session.frames.back().time_s + options_.registration.lidar.margin_s;
  const bool any = std::ranges::any_of(
      capture_.scans, [&](const StampedFile& scan) { return scan.time_s >= first_s && scan.time_s <= last_s; });
  if (any) return;
  check_.warnings.push_back(fmt::format(
      "{}: no scan at its time, from {:.3f} to {:.3f} s; it stays where the poses put it", name, first_s, last_s));
}

}  // namespace cmap
