#pragma once

#include <vector>

#include "cmap/recon/reconstruction.hpp"
#include "described_state.hpp"

namespace cmap {

/// A session on its way through the stages.
struct SessionState {
  SessionOutcome outcome;
  Similarity T_world_session;
  double min_confidence = 0.0;  ///< pixels with less are no points
  /// What the session's camera centers are multiplied by: 1, but for outliers of scale, whose depths have the scale
  /// that was voted for them and whose path has its own.
  double center_factor = 1.0;
  PlacedSession placed;

  bool is_kept() const { return !outcome.dropped.has_value(); }
};

/// Those that are in the map.
std::vector<PlacedSession> placed_of(const std::vector<SessionState>& sessions);

/// A session of the capture as the stages after pre-fusion see it, its camera centers corrected.
SessionPredictions read_corrected(const Capture& capture, const SessionState& state, double farthest_median_depths);

/// sessions.json has these very fields.
template <class Fields>
void describe(Fields& f, StateOf<Fields, SessionOutcome>& o) {
  f.field("index", o.index);
  f.field("name", o.name);
  f.field("frames", o.frames);
  f.field("scale_prefusion", o.scale_prefusion);
  f.field("scale_registration", o.scale_registration);
  f.derived("scale", o.scale());
  f.field("linearity", o.linearity);
  f.field("rotation_corrected", o.rotation_corrected);
  f.field("scale_inlier", o.scale_inlier);
  f.field("prefusion_rmse_m", o.prefusion_rmse_m);
  f.field_or_nan("overlap", o.overlap);
  f.field_or_nan("rmse_m", o.rmse_m);
  f.field("flags", o.flags);
  f.field("dropped", o.dropped);
}

template <class Fields>
void describe(Fields& f, StateOf<Fields, Similarity>& T) {
  f.field("scale", T.scale);
  f.field("rotation", T.rotation);
  f.field("translation", T.translation);
}

template <class Fields>
void describe(Fields& f, StateOf<Fields, PlacedSession>& s) {
  f.field("index", s.index);
  f.field("scale", s.scale);
  f.field("time_s", s.time_s);
  f.field("T_world_camera", s.T_world_camera);
  f.field("rmse_m", s.rmse_m);
}

template <class Fields>
void describe(Fields& f, StateOf<Fields, SessionState>& s) {
  f.field("outcome", s.outcome);
  f.field("T_world_session", s.T_world_session);
  f.field("min_confidence", s.min_confidence);
  f.field("center_factor", s.center_factor);
  f.field("placed", s.placed);
}

}  // namespace cmap
