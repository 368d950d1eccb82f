#include "cmap/recon/pre_fusion.hpp"

#include <fmt/format.h>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

SessionRegistration registered(const std::vector<SessionFrame>& frames, std::size_t k, const Trajectory& world_T_imu,
                               const CameraMount& mount, const PreFusionOptions& options) {
  std::vector<double> times_s;
  for (const SessionFrame& frame : frames) times_s.push_back(frame.time_s);
  try {
    return register_session(frames, camera_poses(world_T_imu, mount, times_s, options.pairing, options.max_gap_s),
                            options.registration);
  } catch (const UnsupportedError& error) {
    throw UnsupportedError(fmt::format("session {}: {}", k, error.what()));
  }
}

}  // namespace

PreFusionOptions PreFusionOptions::paper() {
  PreFusionOptions options;
  options.pairing = PosePairing::kNearest;
  options.registration.rotation = RotationCorrection::kPaper;
  options.voting.mode = ScaleVoting::kPaper;
  return options;
}

PreFusion pre_fuse(std::span<const std::vector<SessionFrame>> sessions, const Trajectory& world_T_imu,
                   const CameraMount& mount, std::span<const std::optional<ScaleRatio>> ratios,
                   const PreFusionOptions& options) {
  PreFusion result;
  std::vector<SessionScale> scales;
  for (std::size_t k = 0; k < sessions.size(); ++k) {
    const SessionRegistration& r =
        result.registrations.emplace_back(registered(sessions[k], k, world_T_imu, mount, options));
    scales.push_back({r.T_world_session.scale, r.linearity, r.sigma_log_scale, r.has_baseline});
  }
  result.voted = vote_scales(scales, ratios, options.voting);
  for (std::size_t k = 0; k < sessions.size(); ++k) {
    result.T_world_session.push_back(with_scale(result.registrations[k], result.voted.scales[k]));
  }
  return result;
}

}  // namespace cmap
