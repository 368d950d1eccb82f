#pragma once

#include "cmap/geometry/rotation.hpp"
#include "node_graph.hpp"

namespace cmap::graph {

/// r of a link between two nodes, not yet weighted, and its derivatives by the nodes' own small motions: t + d_t (world
/// axes), R Exp(d_r), log s + d_s.
struct LinkError {
  Vector7d r;
  Matrix7d by_from, by_to;
};

inline Vector7d link_residual(const Node& from, const Node& to, const Node& relative) {
  Vector7d r;
  const Eigen::Vector3d step = from.rotation.conjugate() * (to.translation - from.translation);
  r.head<3>() = step * std::exp(-from.log_scale) - relative.translation;
  r.segment<3>(3) = rotation_log(relative.rotation.conjugate() * from.rotation.conjugate() * to.rotation);
  r[6] = to.log_scale - from.log_scale - relative.log_scale;
  return r;
}

inline LinkError link_error(const Node& from, const Node& to, const Node& relative) {
  LinkError e{link_residual(from, to, relative), Matrix7d::Zero(), Matrix7d::Zero()};
  const double shrink = std::exp(-from.log_scale);
  const Eigen::Matrix3d to_from_axes = shrink * from.rotation.conjugate().toRotationMatrix();
  const Eigen::Vector3d step = to_from_axes * (to.translation - from.translation);
  const Eigen::Matrix3d by_turn = inverse_right_jacobian(e.r.segment<3>(3));
  e.by_from.topLeftCorner<3, 3>() = -to_from_axes;
  e.by_from.block<3, 3>(0, 3) = cross_matrix(step);
  e.by_from.block<3, 1>(0, 6) = -step;
  e.by_from.block<3, 3>(3, 3) = -by_turn * (to.rotation.conjugate() * from.rotation).toRotationMatrix();
  e.by_from(6, 6) = -1.0;
  e.by_to.topLeftCorner<3, 3>() = to_from_axes;
  e.by_to.block<3, 3>(3, 3) = by_turn;
  e.by_to(6, 6) = 1.0;
  return e;
}

inline Node from_node(const NodeGraph& graph, const Link& link) {
  return link.from == kWorld ? Node{} : graph.nodes[link.from];
}

/// r^T information r.
inline double squared_error(const NodeGraph& graph, const Link& link) {
  return (link.sqrt_information * link_residual(from_node(graph, link), graph.nodes[link.to], link.relative))
      .squaredNorm();
}

/// rho of a squared error.
inline double robust_cost(double squared_error, double cauchy_width) {
  if (cauchy_width == 0.0) return squared_error;
  const double sq_width = cauchy_width * cauchy_width;
  return sq_width * std::log1p(squared_error / sq_width);
}

/// rho', the weight of a link.
inline double robust_slope(double squared_error, double cauchy_width) {
  return cauchy_width == 0.0 ? 1.0 : 1.0 / (1.0 + squared_error / (cauchy_width * cauchy_width));
}

}  // namespace cmap::graph
