#include "posegraph/stage.hpp"

#include <algorithm>

namespace cmap {

PoseGraphOut run_pose_graph(const PoseGraphIn& in, const SessionGraphOptions& options) {
  const PoseGraph graph = session_graph(in.sessions, in.links, in.odometry, options);
  const PoseGraphResult found = optimize(graph);
  PoseGraphOut out{with_poses(in.sessions, found.poses),
                   {found.initial_cost, found.final_cost, found.iterations, 0.0},
                   found.converged,
                   found.warnings};
  for (std::size_t node = 0; node < graph.poses.size(); ++node) {
    const double moved_m = (found.poses[node].translation() - graph.poses[node].translation()).norm();
    out.summary.largest_correction_m = std::max(out.summary.largest_correction_m, moved_m);
  }
  return out;
}

}  // namespace cmap
