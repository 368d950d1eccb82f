#include "cmap/recon/session_graph.hpp"

#include <algorithm>

#include "cmap/geometry/order_statistics.hpp"
#include "degrees.hpp"

namespace cmap {
namespace {

PoseGraph::Information information(double sigma_m, double sigma_deg) {
  const double sigma_rad = sigma_deg * kDegree_rad;
  PoseGraph::Information result = PoseGraph::Information::Zero();
  result.diagonal() << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
  return result;
}

/// VGGT's own motion from one frame to a later one.
PoseGraph::Edge motion_edge(const PlacedSession& session, std::size_t first_node, std::size_t i, std::size_t j,
                            const SessionGraphOptions& options) {
  const Eigen::Isometry3d T = session.T_world_camera[i].inverse() * session.T_world_camera[j];
  const double sigma_m = options.motion_sigma_share * T.translation().norm() + options.motion_sigma_m;
  return {first_node + i, first_node + j, T, information(sigma_m, options.motion_sigma_deg), 0.0};
}

std::vector<std::size_t> first_nodes(std::span<const PlacedSession> sessions) {
  std::vector<std::size_t> first;
  std::size_t n = 0;
  for (const PlacedSession& session : sessions) {
    first.push_back(n);
    n += session.T_world_camera.size();
  }
  return first;
}

/// Whether odometry has the cameras about where they are.
bool agrees(const PlacedSession& session, const OdometryPoses& odometry, const SessionGraphOptions& options) {
  std::vector<double> distances_m, angles_rad;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    if (!odometry[i]) continue;
    const Eigen::Isometry3d apart = odometry[i]->inverse() * session.T_world_camera[i];
    distances_m.push_back(apart.translation().norm());
    angles_rad.push_back(Eigen::AngleAxisd(apart.linear()).angle());
  }
  return !distances_m.empty() && median(distances_m) <= options.odometry_gate_m &&
         median(angles_rad) <= options.odometry_gate_deg * kDegree_rad;
}

void add_motions(const PlacedSession& session, std::size_t first_node, const SessionGraphOptions& options,
                 PoseGraph& graph) {
  const std::size_t n = session.T_world_camera.size(), reach = static_cast<std::size_t>(options.motion_reach);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t step = 1; step <= reach && i + step < n; ++step) {
      graph.edges.push_back(motion_edge(session, first_node, i, i + step, options));
    }
  }
}

void add_priors(const PlacedSession& session, const OdometryPoses* odometry, std::size_t first_node,
                const SessionGraphOptions& options, PoseGraph& graph) {
  const auto by_registration = information(std::max(options.prior_sigma_m, session.rmse_m), options.prior_sigma_deg);
  const auto by_odometry = information(options.odometry_sigma_m, options.odometry_sigma_deg);
  const bool with_odometry = odometry != nullptr && agrees(session, *odometry, options);
  for (std::size_t i = 0; i < session.T_world_camera.size(); ++i) {
    graph.priors.push_back({first_node + i, session.T_world_camera[i], by_registration, options.cauchy_width});
    if (!with_odometry || !(*odometry)[i]) continue;
    graph.priors.push_back({first_node + i, *(*odometry)[i], by_odometry, options.cauchy_width});
  }
}

}  // namespace

PoseGraph session_graph(std::span<const PlacedSession> sessions, std::span<const SessionLink> links,
                        std::span<const OdometryPoses> odometry, const SessionGraphOptions& options) {
  PoseGraph graph;
  const std::vector<std::size_t> first = first_nodes(sessions);
  for (std::size_t k = 0; k < sessions.size(); ++k) {
    const std::vector<Eigen::Isometry3d>& cameras = sessions[k].T_world_camera;
    graph.poses.insert(graph.poses.end(), cameras.begin(), cameras.end());
    add_motions(sessions[k], first[k], options, graph);
    if (options.lidar_priors)
      add_priors(sessions[k], odometry.empty() ? nullptr : &odometry[k], first[k], options, graph);
  }
  for (const SessionLink& link : links) {
    graph.edges.push_back({first[link.from] + link.from_frame, first[link.to] + link.to_frame, link.T_from_to,
                           information(std::max(options.link_sigma_m, link.rmse_m), options.link_sigma_deg),
                           options.cauchy_width});
  }
  return graph;
}

std::vector<PlacedSession> with_poses(std::span<const PlacedSession> sessions,
                                      std::span<const Eigen::Isometry3d> node_poses) {
  std::vector<PlacedSession> moved(sessions.begin(), sessions.end());
  std::size_t node = 0;
  for (PlacedSession& session : moved) {
    for (Eigen::Isometry3d& pose : session.T_world_camera) pose = node_poses[node++];
  }
  return moved;
}

}  // namespace cmap
