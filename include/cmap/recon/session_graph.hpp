#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cmap/geometry/similarity.hpp"
#include "cmap/graph/pose_graph.hpp"
#include "cmap/recon/session_points.hpp"
#include "cmap/recon/session_registration.hpp"

namespace cmap {

/// A session in the world: where its cameras are, and the meters in its unit.
struct PlacedSession {
  std::size_t index = 0;  ///< of the capture's sessions
  double scale = 1.0;
  std::vector<double> time_s;                     ///< of the frames
  std::vector<Eigen::Isometry3d> T_world_camera;  ///< of the frames
  double rmse_m = 0.0;                            ///< of its registration
};

std::vector<double> times_of(const SessionPredictions& session);

/// A session's frames without their pictures.
std::vector<SessionFrame> frames_of(const SessionPredictions& session);

/// A session's cameras where a similarity puts them.
PlacedSession placed_session(std::size_t index, std::span<const SessionFrame> frames, const Similarity& T_world_session,
                             double rmse_m);

/// Where two neighboring sessions say that one frame of both is, relative to each other.
struct SessionLink {
  std::size_t from = 0, to = 0;  ///< places in the list of sessions
  std::size_t from_frame = 0, to_frame = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();  ///< between the two cameras, m
  double rmse_m = 0.0;
  std::size_t n_points = 0;
  bool refined = false;  ///< by ICP; else from equal pixels alone
};

struct LinkOptions {
  double voxel_m = 0.2;
  PointSource source = PointSource::kDepth;
  double cauchy_width = 1.0;  ///< of the edge, standard deviations
};

/// The motion that brings b onto a where they share frames (equal times): from the points of equal pixels (rigid,
/// Cauchy weights), refined by ICP of the shared frames' points. None where they share no frame or fewer than 100 good
/// pixels; `reason` says which.
std::optional<SessionLink> link_sessions(const SessionPredictions& a, const PlacedSession& placed_a,
                                         double min_confidence_a, const SessionPredictions& b,
                                         const PlacedSession& placed_b, double min_confidence_b,
                                         const LinkOptions& options, std::string& reason);

struct SessionGraphOptions {
  bool lidar_priors = true;   ///< every frame also stays near where registration and odometry have put it
  double cauchy_width = 1.0;  ///< of links and priors, standard deviations
};

/// Where LiDAR-inertial odometry has a session's cameras; none where it has no pose.
using OdometryPoses = std::vector<std::optional<Eigen::Isometry3d>>;

/// The graph of all frames (PIPELINE, "Pose graph"): one node for each frame of each session, in order; edges between
/// consecutive and second-next frames, links between sessions, priors. The first node is fixed.
/// Priors: where registration has put each frame, and, in sessions that agree with it, where LiDAR-inertial odometry
/// has it (`odometry`, one for each session, or empty). Registration finds a session's scale and direction better than
/// its poses alone do, and slides along what it matches; where it has moved the cameras of a session by more than 0.3 m
/// or 1.5 degrees (medians), calibration, clock or depths are off, and odometry would tear the map apart again.
PoseGraph session_graph(std::span<const PlacedSession> sessions, std::span<const SessionLink> links,
                        std::span<const OdometryPoses> odometry, const SessionGraphOptions& options);

/// The sessions with their nodes' poses.
std::vector<PlacedSession> with_poses(std::span<const PlacedSession> sessions,
                                      std::span<const Eigen::Isometry3d> node_poses);

}  // namespace cmap
