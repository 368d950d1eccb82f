#include "cmap/graph/pose_graph.hpp"

#include <fmt/format.h>

#include <functional>

#include "chordal.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "link_error.hpp"
#include "solver.hpp"

namespace cmap {
namespace {

using graph::NodeGraph;
using graph::Outcome;

void check_options(const GraphOptions& options) {
  if (options.max_iterations < 1) {
    throw UsageError(fmt::format("max_iterations is {}: at least 1 expected", options.max_iterations));
  }
  if (!(options.function_tolerance > 0.0 && options.function_tolerance < 1.0)) {
    throw UsageError(fmt::format("function_tolerance is {:g}: between 0 and 1 expected", options.function_tolerance));
  }
}

double cost_of(const NodeGraph& graph) {
  double cost = 0.0;
  for (const graph::Link& link : graph.links) cost += graph::robust_cost(squared_error(graph, link), link.cauchy_width);
  return cost;
}

template <class Pose>
std::vector<Pose> poses_of(const NodeGraph& graph, std::span<const Pose> before) {
  std::vector<Pose> poses(before.begin(), before.end());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!graph.is_fixed[i]) store(graph.nodes[i], poses[i]);
  }
  return poses;
}

/// One start and where it led.
struct Run {
  NodeGraph graph;
  bool is_chordal = false;
  std::string failure;  ///< why there is no result
  Outcome outcome{};

  template <class Step>
  void attempt(Step&& step) {
    if (!failure.empty()) return;
    try {
      step();
    } catch (const UnsupportedError& error) {
      failure = error.what();
    }
  }
  void solve(const GraphOptions& options) {
    const int dim = graph.dim;
    const auto cost = [dim](const graph::Link& link) { return graph::log_cost(link, dim); };
    attempt([&] { outcome = graph::solve(graph, cost, options); });
  }
};

/// The starts that were asked for, the graph's own poses first.
std::vector<Run> starts(const NodeGraph& nodes, GraphStart start) {
  std::vector<Run> runs;
  if (start != GraphStart::kChordal) runs.push_back({nodes, false, {}});
  if (start == GraphStart::kPoses) return runs;
  runs.push_back({nodes, true, {}});
  Run& chordal = runs.back();
  chordal.attempt([&] { start_from_chordal(chordal.graph); });
  if (start == GraphStart::kLower && chordal.failure.empty()) {
    runs.erase(cost_of(chordal.graph) < cost_of(nodes) ? runs.begin() : runs.begin() + 1);
  }
  return runs;
}

std::vector<Run> solved_runs(const NodeGraph& nodes, const GraphOptions& options) {
  std::vector<Run> runs = starts(nodes, options.start);
  std::vector<std::function<void()>> tasks;
  for (Run& run : runs) tasks.emplace_back([&run, &options] { run.solve(options); });
  parallel_tasks(tasks);
  return runs;
}

const Run& best_of(const std::vector<Run>& runs) {
  const Run* best = nullptr;
  for (const Run& run : runs) {
    if (!run.failure.empty()) continue;
    if (best == nullptr || run.outcome.final_cost < best->outcome.final_cost) best = &run;
  }
  if (best == nullptr) throw UnsupportedError(runs.front().failure);
  return *best;
}

template <class Pose, int kDim>
GraphResult<Pose> optimize_graph(const Graph<Pose, kDim>& graph, const GraphOptions& options) {
  check_options(options);
  const NodeGraph nodes = graph::node_graph(graph, graph.poses);
  const std::vector<Run> runs = solved_runs(nodes, options);
  const Run& best = best_of(runs);
  GraphResult<Pose> result;
  result.poses = poses_of<Pose>(best.graph, graph.poses);
  result.initial_cost = cost_of(nodes);
  result.start_cost = best.outcome.start_cost;
  result.final_cost = best.outcome.final_cost;
  result.iterations = best.outcome.iterations;
  result.converged = best.outcome.converged;
  result.chordal_start = best.is_chordal;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    result.edge_costs.push_back(squared_error(best.graph, best.graph.links[i]));
  }
  for (const Run& run : runs) {
    if (!run.failure.empty()) result.warnings.push_back(run.failure);
  }
  if (!result.converged) {
    result.warnings.push_back(fmt::format("not converged after {} iterations", result.iterations));
  }
  return result;
}

template <class Pose, int kDim>
std::vector<Pose> chordal(const Graph<Pose, kDim>& graph) {
  NodeGraph nodes = graph::node_graph(graph, graph.poses);
  start_from_chordal(nodes);
  return poses_of<Pose>(nodes, graph.poses);
}

}  // namespace

PoseGraphResult optimize(const PoseGraph& graph, const GraphOptions& options) { return optimize_graph(graph, options); }

ScaledPoseGraphResult optimize(const ScaledPoseGraph& graph, const GraphOptions& options) {
  return optimize_graph(graph, options);
}

double graph_cost(const PoseGraph& graph, std::span<const Eigen::Isometry3d> poses) {
  return cost_of(graph::node_graph(graph, poses));
}

double graph_cost(const ScaledPoseGraph& graph, std::span<const Similarity> poses) {
  return cost_of(graph::node_graph(graph, poses));
}

std::vector<Eigen::Isometry3d> chordal_poses(const PoseGraph& graph) { return chordal(graph); }

std::vector<Similarity> chordal_poses(const ScaledPoseGraph& graph) { return chordal(graph); }

}  // namespace cmap
