#pragma once

#include <ceres/cost_function.h>

#include <functional>
#include <memory>

#include "node_graph.hpp"

namespace cmap::graph {

/// Ceres' parameter block of a node: translation, quaternion x y z w, log scale. Cost functions write derivatives by
/// the node's small motion (see LinkError) into the first `dim` columns of a block's Jacobian and zeros into the
/// others.
inline constexpr int kBlockSize = 8;

Node node_at(const double* block);

/// The cost function of a link: of blocks `from` and `to`, of `to` alone for priors.
using LinkCost = std::function<std::unique_ptr<ceres::CostFunction>(const Link& link)>;

/// The production one: U r.
std::unique_ptr<ceres::CostFunction> log_cost(const Link& link, int dim);

struct Outcome {
  double start_cost = 0.0, final_cost = 0.0;  ///< without the factor 1/2
  int iterations = 0;
  bool converged = false;
};

/// Moves the nodes to where the links' costs are least. Throws UnsupportedError where Ceres cannot go on.
Outcome solve(NodeGraph& graph, const LinkCost& link_cost, const GraphOptions& options);

}  // namespace cmap::graph
