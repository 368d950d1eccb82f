#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "cmap/graph/pose_graph.hpp"
#include "cmap/recon/camera_poses.hpp"
#include "cmap/recon/placed_session.hpp"
#include "cmap/recon/session_link.hpp"

namespace cmap {

/// Standard deviations of what the pose graph weighs against each other, in meters and degrees.
struct SessionGraphOptions {
  int motion_reach = 2;              ///< a frame's motion to this many later frames of its session counts
  double motion_sigma_share = 0.02;  ///< of VGGT's motion between frames: this share of its length,
  double motion_sigma_m = 0.02;      ///< and this
  double motion_sigma_deg = 0.3;
  double link_sigma_m = 0.05;  ///< of a link: its RMSE, but no less than this
  double link_sigma_deg = 0.2;
  bool lidar_priors = true;    ///< every frame also stays near where registration and odometry have put it
  double prior_sigma_m = 0.1;  ///< of registration: the session's RMSE, but no less than this
  double prior_sigma_deg = 0.5;
  double odometry_sigma_m = 0.1;
  double odometry_sigma_deg = 0.5;
  double odometry_gate_m = 0.3;    ///< sessions whose cameras odometry has farther away (median) do without it,
  double odometry_gate_deg = 1.5;  ///< likewise
  double cauchy_width = 1.0;       ///< of links and priors, standard deviations
};

/// The graph of all frames (PIPELINE, "Pose graph"): one node for each frame of each session, in order; edges between
/// a frame and those after it, links between sessions, priors. The first node is fixed.
/// Priors: where registration has put each frame, and, in sessions that agree with it, where LiDAR-inertial odometry
/// has it (`odometry`, one for each session, or empty). Registration finds a session's scale and direction better than
/// its poses alone do, and slides along what it matches; where it has moved the cameras of a session out of odometry's
/// gate, calibration, clock or depths are off, and odometry would tear the map apart again.
PoseGraph session_graph(std::span<const PlacedSession> sessions, std::span<const SessionLink> links,
                        std::span<const OdometryPoses> odometry, const SessionGraphOptions& options);

/// The sessions with their nodes' poses.
std::vector<PlacedSession> with_poses(std::span<const PlacedSession> sessions,
                                      std::span<const Eigen::Isometry3d> node_poses);

}  // namespace cmap
