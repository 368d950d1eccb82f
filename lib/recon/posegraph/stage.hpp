#pragma once

#include <span>
#include <string>
#include <vector>

#include "cmap/recon/session_graph.hpp"
#include "sessions/session_state.hpp"

namespace cmap {

struct PoseGraphIn {
  std::span<const PlacedSession> sessions;  ///< as registration has put them
  std::span<const SessionLink> links;
  std::span<const OdometryPoses> odometry;  ///< of each session, or empty
};

struct PoseGraphOut {
  std::vector<PlacedSession> sessions;  ///< their cameras moved
  GraphSummary summary;
  bool converged = false;
  std::vector<std::string> warnings;  ///< of the solver
};

/// report.json has these very fields.
template <class Fields>
void describe(Fields& f, StateOf<Fields, GraphSummary>& s) {
  f.field("cost_before", s.cost_before);
  f.field("cost_after", s.cost_after);
  f.field("iterations", s.iterations);
  f.field("largest_correction_m", s.largest_correction_m);
}

template <class Fields>
void describe(Fields& f, StateOf<Fields, PoseGraphOut>& out) {
  f.field("sessions", out.sessions);
  f.field("summary", out.summary);
  f.field("converged", out.converged);
  f.field("warnings", out.warnings);
}

/// The third stage: all frames of all sessions at once. Reads no files. Throws as optimize().
PoseGraphOut run_pose_graph(const PoseGraphIn& in, const SessionGraphOptions& options);

}  // namespace cmap
