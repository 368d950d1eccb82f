#pragma once

#include <map>
#include <string>
#include <vector>

#include "cmap/recon/capture_check.hpp"
#include "sessions/time_spans.hpp"

namespace cmap {

/// Checks sessions one after another, as each is also compared with those before.
class SessionCheck {
 public:
  SessionCheck(const Capture& capture, const ReconstructionOptions& options, CaptureCheck& check);

  void add(std::size_t index);
  std::size_t frames() const { return n_frames_; }

 private:
  void compare_with_poses(const std::string& name, const SessionPredictions& session);
  void compare_with_images(const std::string& name, const SessionPredictions& session);
  void compare_with_scans(const std::string& name, const SessionPredictions& session);

  const Capture& capture_;
  const ReconstructionOptions& options_;
  CaptureCheck& check_;
  std::map<std::string, double> image_times_s_;  ///< by file name
  SeenTimes seen_;
  std::size_t n_frames_ = 0;
};

}  // namespace cmap
