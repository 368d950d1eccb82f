#include "loops/loop_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cmap {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

PoseGraph::Information information(double sigma_m, double sigma_deg) {
  const double sigma_rad = sigma_deg * kDegree_rad;
  PoseGraph::Information result = PoseGraph::Information::Zero();
  result.diagonal() << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
  return result;
}

PoseGraph::Edge odometry_edge(std::span<const Keyframe> keyframes, std::size_t to, const LoopOptions& options) {
  constexpr double kShortest_m = 0.05;  // at rest odometry is not exact either
  const Eigen::Isometry3d T = keyframes[to - 1].T_world_body.inverse() * keyframes[to].T_world_body;
  const double root_m = std::sqrt(std::max(kShortest_m, T.translation().norm()));
  return {to - 1, to, T,
          information(options.odometry_sigma_m_per_sqrt_m * root_m, options.odometry_sigma_deg_per_sqrt_m * root_m),
          0.0};
}

/// Log(R_odometry^T R) is along the body's up where only the heading differs, whatever by: that alone is free.
PoseGraph::Prior gravity_prior(const Keyframe& keyframe, std::size_t node, const LoopOptions& options) {
  const double sigma_rad = options.gravity_sigma_deg * kDegree_rad;
  const Eigen::Vector3d up = keyframe.T_world_body.linear().transpose() * Eigen::Vector3d::UnitZ();
  PoseGraph::Prior prior{node, keyframe.T_world_body, PoseGraph::Information::Zero(), 0.0};
  prior.information.bottomRightCorner<3, 3>() =
      (Eigen::Matrix3d::Identity() - up * up.transpose()) / (sigma_rad * sigma_rad);
  return prior;
}

PoseGraph::Edge loop_edge(const LoopCandidate& loop, const LoopOptions& options) {
  const double sigma_m = std::hypot(options.loop_sigma_m, std::isfinite(loop.error_m) ? loop.error_m : 0.0);
  return {loop.from, loop.to, loop.T_from_to, information(sigma_m, options.loop_sigma_deg), options.cauchy_width};
}

/// The optimum for kernels from wide to narrow; the first run knows no outliers.
PoseGraphResult optimized(PoseGraph graph, std::size_t n_odometry, const LoopOptions& options) {
  PoseGraphResult result;
  for (const double factor : {0.0, 100.0, 30.0, 10.0, 3.0, 1.0}) {
    for (std::size_t e = n_odometry; e < graph.edges.size(); ++e) {
      graph.edges[e].cauchy_width = factor * options.cauchy_width;
    }
    result = optimize(graph, {.start = GraphStart::kPoses, .max_iterations = 50, .function_tolerance = 1e-8});
    graph.poses = result.poses;
  }
  return result;
}

std::vector<LoopCandidate*> accepted(std::vector<LoopCandidate>& candidates) {
  std::vector<LoopCandidate*> loops;
  for (LoopCandidate& candidate : candidates) {
    if (candidate.accepted) loops.push_back(&candidate);
  }
  return loops;
}

/// Fills residuals; drops the loop that the result contradicts most. Whether there was one.
bool drop_worst(const PoseGraphResult& result, std::size_t n_odometry, const LoopOptions& options,
                std::vector<LoopCandidate>& candidates) {
  LoopCandidate* worst = nullptr;
  const std::vector<LoopCandidate*> loops = accepted(candidates);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    loops[i]->residual = std::sqrt(result.edge_costs[n_odometry + i]);
    if (loops[i]->residual > options.largest_residual && (worst == nullptr || loops[i]->residual > worst->residual)) {
      worst = loops[i];
    }
  }
  if (worst == nullptr) return false;
  worst->accepted = false;
  worst->reason = fmt::format("dropped: the closed graph contradicts it by {:.1f} standard deviations, {:g} at most",
                              worst->residual, options.largest_residual);
  return true;
}

}  // namespace

PoseGraph loop_graph(std::span<const Keyframe> keyframes, std::span<const LoopCandidate> candidates,
                     const LoopOptions& options) {
  PoseGraph graph;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    graph.poses.push_back(keyframes[i].T_world_body);
    if (i > 0) graph.edges.push_back(odometry_edge(keyframes, i, options));
    if (options.gravity_sigma_deg > 0.0) graph.priors.push_back(gravity_prior(keyframes[i], i, options));
  }
  for (const LoopCandidate& candidate : candidates) {
    if (candidate.accepted) graph.edges.push_back(loop_edge(candidate, options));
  }
  return graph;
}

void close_graph(std::span<const Keyframe> keyframes, const LoopOptions& options, LoopClosure& closure) {
  closure.poses.clear();
  for (const Keyframe& keyframe : keyframes) closure.poses.push_back(keyframe.T_world_body);
  const std::size_t n_odometry = keyframes.empty() ? 0 : keyframes.size() - 1;
  while (!accepted(closure.candidates).empty()) {
    const PoseGraph graph = loop_graph(keyframes, closure.candidates, options);
    const PoseGraphResult result = optimized(graph, n_odometry, options);
    closure.initial_cost = graph_cost(graph, graph.poses);
    closure.final_cost = result.final_cost;
    if (drop_worst(result, n_odometry, options, closure.candidates)) continue;
    closure.poses = result.poses;
    break;
  }
  closure.n_loops = accepted(closure.candidates).size();
  if (closure.n_loops == 0) closure.initial_cost = closure.final_cost = 0.0;
  closure.largest_change_m = 0.0;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const Eigen::Vector3d change = closure.poses[i].translation() - keyframes[i].T_world_body.translation();
    closure.largest_change_m = std::max(closure.largest_change_m, change.norm());
  }
}

}  // namespace cmap
