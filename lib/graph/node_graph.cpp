#include "node_graph.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "cmap/core/error.hpp"
#include "cmap/geometry/rotation.hpp"

namespace cmap::graph {
namespace {

/// Rotations read from float files are orthonormal to 1e-7; more is no rotation.
constexpr double kOrthonormal = 1e-3;
/// Symmetry and semidefiniteness hold up to the rounding of printed numbers.
constexpr double kInformationRounding = 1e-6;

[[noreturn]] void fail(const std::string& what) { throw std::invalid_argument("pose graph: " + what); }

Node node_of(const Eigen::Isometry3d& pose, const std::string& what) {
  const Eigen::Matrix3d R = pose.linear();
  if (!pose.matrix().allFinite()) fail(what + " is not finite");
  if (deviation_from_rotation(R) > kOrthonormal) fail(what + " has no rotation");
  return {pose.translation(), Eigen::Quaterniond(R).normalized(), 0.0};
}

Node node_of(const Similarity& pose, const std::string& what) {
  if (!(pose.scale > 0.0) || !std::isfinite(pose.scale)) fail(fmt::format("{} has the scale {:g}", what, pose.scale));
  Eigen::Isometry3d rigid = Eigen::Isometry3d::Identity();
  rigid.linear() = pose.rotation;
  rigid.translation() = pose.translation;
  Node node = node_of(rigid, what);
  node.log_scale = std::log(pose.scale);
  return node;
}

/// U with U^T U = information.
template <int kDim>
Eigen::Matrix<double, kDim, kDim> square_root(const Eigen::Matrix<double, kDim, kDim>& information,
                                              const std::string& what) {
  if (!information.allFinite()) fail("the information of " + what + " is not finite");
  const double rounding = kInformationRounding * information.cwiseAbs().maxCoeff();
  if ((information - information.transpose()).cwiseAbs().maxCoeff() > rounding) {
    fail("the information of " + what + " is not symmetric");
  }
  const Eigen::LLT<Eigen::Matrix<double, kDim, kDim>> cholesky(information);
  if (cholesky.info() == Eigen::Success) return cholesky.matrixU();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kDim, kDim>> eigen(information);
  if (eigen.eigenvalues()[0] < -rounding) fail("the information of " + what + " is not positive semidefinite");
  return eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
}

template <class Pose, int kDim>
Link link_of(std::size_t from, std::size_t to, const Pose& relative,
             const Eigen::Matrix<double, kDim, kDim>& information, double cauchy_width, const std::string& what) {
  Link link{from, to, node_of(relative, what), Matrix7d::Zero(), Eigen::Vector3d::Zero(), cauchy_width};
  link.sqrt_information.topLeftCorner<kDim, kDim>() = square_root<kDim>(information, what);
  const auto diagonal = information.diagonal();
  link.mean_information << diagonal.template head<3>().mean(), diagonal.template segment<3>(3).mean(),
      kDim == 7 ? diagonal[kDim - 1] : 0.0;
  if (!(cauchy_width >= 0.0) || !std::isfinite(cauchy_width))
    fail(fmt::format("{} has the width {:g}", what, cauchy_width));
  return link;
}

/// Every node must be held by a fixed node or a prior, through whatever edges.
void require_held(const NodeGraph& graph) {
  std::vector<std::vector<std::size_t>> neighbors(graph.nodes.size());
  std::vector<char> held = graph.is_fixed;
  for (const Link& link : graph.links) {
    if (link.from == kWorld) {
      held[link.to] = 1;
    } else {
      neighbors[link.from].push_back(link.to);
      neighbors[link.to].push_back(link.from);
    }
  }
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i]) open.push_back(i);
  }
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    for (const std::size_t next : neighbors[node]) {
      if (!held[next]) open.push_back(next);
      held[next] = 1;
    }
  }
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (!held[i])
      throw UnsupportedError(fmt::format("node {} of the pose graph is connected to no fixed node and no prior", i));
  }
}

template <class Pose, int kDim>
NodeGraph convert(const Graph<Pose, kDim>& graph, std::span<const Pose> poses) {
  NodeGraph result;
  result.dim = kDim;
  const std::size_t n = graph.poses.size();
  if (poses.size() != n) fail(fmt::format("{} poses for {} nodes", poses.size(), n));
  for (std::size_t i = 0; i < n; ++i) result.nodes.push_back(node_of(poses[i], fmt::format("the pose of node {}", i)));
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const auto& edge = graph.edges[i];
    const std::string what = fmt::format("edge {} ({} to {})", i, edge.from, edge.to);
    if (edge.from >= n || edge.to >= n) fail(fmt::format("{}: there are {} nodes", what, n));
    if (edge.from == edge.to) fail(what + " leads back to its node");
    result.links.push_back(
        link_of<Pose, kDim>(edge.from, edge.to, edge.T_from_to, edge.information, edge.cauchy_width, what));
  }
  for (std::size_t i = 0; i < graph.priors.size(); ++i) {
    const auto& prior = graph.priors[i];
    const std::string what = fmt::format("prior {} (node {})", i, prior.node);
    if (prior.node >= n) fail(fmt::format("{}: there are {} nodes", what, n));
    result.links.push_back(
        link_of<Pose, kDim>(kWorld, prior.node, prior.T_world_node, prior.information, prior.cauchy_width, what));
  }
  result.is_fixed.assign(n, 0);
  for (const std::size_t node : graph.fixed) {
    if (node >= n) fail(fmt::format("node {} is fixed; there are {} nodes", node, n));
    result.is_fixed[node] = 1;
  }
  require_held(result);
  return result;
}

}  // namespace

NodeGraph node_graph(const PoseGraph& graph, std::span<const Eigen::Isometry3d> poses) { return convert(graph, poses); }

NodeGraph node_graph(const ScaledPoseGraph& graph, std::span<const Similarity> poses) { return convert(graph, poses); }

void store(const Node& node, Eigen::Isometry3d& pose) {
  pose.setIdentity();
  pose.linear() = node.rotation.toRotationMatrix();
  pose.translation() = node.translation;
}

void store(const Node& node, Similarity& pose) {
  pose = {std::exp(node.log_scale), node.rotation.toRotationMatrix(), node.translation};
}

}  // namespace cmap::graph
