#include "fusion/stage.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

/// Evenly chosen pixels, about kSketchPoints of a session.
void add_sketch(const FramePoints& points, std::size_t frame, std::size_t n_frames, SessionSketch& sketch) {
  constexpr std::size_t kSketchPoints = 60'000;
  const std::size_t step = std::max<std::size_t>(1, points.positions.size() * n_frames / kSketchPoints);
  for (std::size_t i = step / 2; i < points.positions.size(); i += step) {
    sketch.positions.push_back(points.positions[i]);
    sketch.frame.push_back(static_cast<std::uint32_t>(frame));
  }
}

/// In the session's unit.
double max_range(const FusionOptions& options, const PlacedSession& placed) {
  return options.max_range_m > 0.0 ? options.max_range_m / placed.scale : std::numeric_limits<double>::infinity();
}

}  // namespace

FusionOut run_fusion(const FusionIn& in, const SessionInputOptions& input, const FusionOptions& options,
                     const std::function<void(double)>& progress) {
  FusionOut out;
  MapFusion fusion(options);
  std::size_t k = 0;
  for (const SessionState& state : in.sessions) {
    if (!state.is_kept()) continue;
    if (progress) progress(static_cast<double>(k) / static_cast<double>(in.poses.size()));
    const PlacedSession& placed = in.poses[k++];
    const SessionPredictions session = read_corrected(in.capture, state, input.farthest_median_depths);
    SessionSketch& sketch = out.sketches.emplace_back();
    std::optional<MapFusion> alone;
    if (in.session_map) alone.emplace(options);
    for (std::size_t i = 0; i < session.frame_count(); ++i) {
      const FramePoints points =
          frame_points(session, i, state.min_confidence, input.points, max_range(options, placed));
      fusion.add(points, placed.T_world_camera[i], placed.scale);
      if (alone) alone->add(points, placed.T_world_camera[i], placed.scale);
      add_sketch(points, i, session.frame_count(), sketch);
    }
    if (alone && alone->size() > 0) in.session_map(state.outcome.name, alone->finish());
  }
  if (fusion.size() == 0) {
    throw UnsupportedError(fmt::format("no point is within fusion_max_range_m, {:g} m", options.max_range_m));
  }
  out.points_fused = fusion.points_added();
  out.map = fusion.finish();
  return out;
}

}  // namespace cmap
