#include "cmap/recon/pre_fusion.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

SessionPlacement placed(const std::vector<SessionFrame>& frames, const OdometryPoses& T_world_camera, std::size_t k,
                        const SessionPlacementOptions& options) {
  try {
    return place_session(frames, T_world_camera, options);
  } catch (const UnsupportedError& error) {
    throw UnsupportedError(fmt::format("session {}: {}", k, error.what()));
  }
}

}  // namespace

PreFusionOptions PreFusionOptions::paper() {
  PreFusionOptions options;
  options.placement.rotation = RotationCorrection::kPaper;
  options.overlap_scale = OverlapScale::kCenters;
  options.voting.mode = ScaleVoting::kPaper;
  return options;
}

PreFusion pre_fuse(std::span<const std::vector<SessionFrame>> sessions, std::span<const OdometryPoses> T_world_camera,
                   std::span<const std::optional<ScaleRatio>> ratios, const PreFusionOptions& options) {
  if (sessions.size() != T_world_camera.size()) {
    throw std::invalid_argument("pre_fuse: sessions and lists of camera poses must be equally many");
  }
  PreFusion result;
  std::vector<SessionScale> scales;
  for (std::size_t k = 0; k < sessions.size(); ++k) {
    const SessionPlacement& r =
        result.placements.emplace_back(placed(sessions[k], T_world_camera[k], k, options.placement));
    scales.push_back({r.T_world_session.scale, r.linearity, r.sigma_log_scale, r.has_baseline});
  }
  result.voted = vote_scales(scales, ratios, options.voting);
  for (std::size_t k = 0; k < sessions.size(); ++k) {
    result.T_world_session.push_back(with_scale(result.placements[k], result.voted.scales[k]));
  }
  return result;
}

}  // namespace cmap
