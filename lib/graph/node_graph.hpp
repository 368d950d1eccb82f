#pragma once

#include <limits>

#include "cmap/graph/pose_graph.hpp"

namespace cmap::graph {

/// A node of either kind of graph. SE(3) nodes keep log_scale 0.
struct Node {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  double log_scale = 0.0;
};

inline constexpr std::size_t kWorld = std::numeric_limits<std::size_t>::max();

/// An edge, or a prior: an edge from the world's own frame.
struct Link {
  std::size_t from = kWorld, to = 0;
  Node relative;
  Matrix7d sqrt_information = Matrix7d::Zero();  ///< U with U^T U = information; SE(3): last row and column zero
  Eigen::Vector3d mean_information = Eigen::Vector3d::Zero();  ///< of translation, rotation, log scale
  double cauchy_width = 0.0;
};

/// Both kinds of graph in one form. SE(3) is Sim(3) without the row and the column of the scale.
struct NodeGraph {
  int dim = 6;  ///< 6 or 7
  std::vector<Node> nodes;
  std::vector<Link> links;  ///< the edges in order, then the priors
  std::vector<char> is_fixed;
};

/// The graph with its nodes at `poses`, checked as optimize() says.
NodeGraph node_graph(const PoseGraph& graph, std::span<const Eigen::Isometry3d> poses);
NodeGraph node_graph(const ScaledPoseGraph& graph, std::span<const Similarity> poses);

void store(const Node& node, Eigen::Isometry3d& pose);
void store(const Node& node, Similarity& pose);

}  // namespace cmap::graph
