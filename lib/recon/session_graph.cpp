#include "cmap/recon/session_graph.hpp"

#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

constexpr double kDeg = M_PI / 180.0;
constexpr double kPriorSigma_rad = 0.5 * kDeg;
constexpr double kOdometrySigma_m = 0.1;

PoseGraph::Information information(double sigma_m, double sigma_rad) {
  PoseGraph::Information result = PoseGraph::Information::Zero();
  result.diagonal() << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
  return result;
}

/// VGGT's own motion from one frame to a later one.
PoseGraph::Edge motion_edge(const PlacedSession& session, std::size_t first_node, std::size_t i, std::size_t j) {
  const Eigen::Isometry3d T = session.T_world_camera[i].inverse() * session.T_world_camera[j];
  const double sigma_m = 0.02 * T.translation().norm() + 0.02;
  return {first_node + i, first_node + j, T, information(sigma_m, 0.3 * kDeg), 0.0};
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
bool agrees(const PlacedSession& session, const OdometryPoses& odometry) {
  std::vector<double> distances_m, angles_rad;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    if (!odometry[i]) continue;
    const Eigen::Isometry3d apart = odometry[i]->inverse() * session.T_world_camera[i];
    distances_m.push_back(apart.translation().norm());
    angles_rad.push_back(Eigen::AngleAxisd(apart.linear()).angle());
  }
  return !distances_m.empty() && median(distances_m) <= 3.0 * kOdometrySigma_m &&
         median(angles_rad) <= 3.0 * kPriorSigma_rad;
}

}  // namespace

std::vector<double> times_of(const SessionPredictions& session) {
  std::vector<double> times_s;
  for (const PredictionFrame& frame : session.frames) times_s.push_back(frame.time_s);
  return times_s;
}

std::vector<SessionFrame> frames_of(const SessionPredictions& session) {
  std::vector<SessionFrame> frames;
  for (std::size_t i = 0; i < session.frame_count(); ++i) {
    frames.push_back({session.frames[i].time_s, session.T_camera_session[i]});
  }
  return frames;
}

PlacedSession placed_session(std::size_t index, std::span<const SessionFrame> frames, const Similarity& T_world_session,
                             double rmse_m) {
  PlacedSession placed{index, T_world_session.scale, {}, {}, rmse_m};
  for (const SessionFrame& frame : frames) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = T_world_session.rotation * frame.T_camera_session.linear().transpose();
    pose.translation() = T_world_session * camera_center(frame);
    placed.time_s.push_back(frame.time_s);
    placed.T_world_camera.push_back(pose);
  }
  return placed;
}

PoseGraph session_graph(std::span<const PlacedSession> sessions, std::span<const SessionLink> links,
                        std::span<const OdometryPoses> odometry, const SessionGraphOptions& options) {
  PoseGraph graph;
  const std::vector<std::size_t> first = first_nodes(sessions);
  for (std::size_t k = 0; k < sessions.size(); ++k) {
    const PlacedSession& session = sessions[k];
    const std::size_t n = session.T_world_camera.size();
    graph.poses.insert(graph.poses.end(), session.T_world_camera.begin(), session.T_world_camera.end());
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t step = 1; step <= 2 && i + step < n; ++step) {
        graph.edges.push_back(motion_edge(session, first[k], i, i + step));
      }
    }
    if (!options.lidar_priors) continue;
    const double sigma_m = std::max(0.1, session.rmse_m);
    const bool with_odometry = !odometry.empty() && agrees(session, odometry[k]);
    for (std::size_t i = 0; i < n; ++i) {
      const auto add_prior = [&](const Eigen::Isometry3d& pose, double sigma_prior_m) {
        graph.priors.push_back({first[k] + i, pose, information(sigma_prior_m, kPriorSigma_rad), options.cauchy_width});
      };
      add_prior(session.T_world_camera[i], sigma_m);
      if (with_odometry && odometry[k][i]) add_prior(*odometry[k][i], kOdometrySigma_m);
    }
  }
  for (const SessionLink& link : links) {
    graph.edges.push_back({first[link.from] + link.from_frame, first[link.to] + link.to_frame, link.T_from_to,
                           information(std::max(0.05, link.rmse_m), 0.2 * kDeg), options.cauchy_width});
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
