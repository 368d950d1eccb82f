#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <variant>

#include "cmap/recon/placed_session.hpp"
#include "cmap/recon/session_points.hpp"

namespace cmap {

/// Where two neighboring sessions say that one frame of both is, relative to each other.
struct SessionLink {
  std::size_t from = 0, to = 0;  ///< places in the list of sessions
  std::size_t from_frame = 0, to_frame = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();  ///< between the two cameras, m
  double rmse_m = 0.0;
  std::size_t n_points = 0;
  bool refined = false;  ///< by ICP; else from equal pixels alone
};

/// Why two sessions have no link, for people.
struct NotLinked {
  std::string reason;
};

struct LinkOptions {
  int min_pixels = 100;       ///< good in both sessions
  int max_pixels = 40'000;    ///< evenly chosen of more
  int rounds = 10;            ///< of reweighting the motion between equal pixels
  double thinning = 0.5;      ///< the clouds of ICP are thinned to this share of its voxel
  double gate = 3.0;          ///< of ICP, in voxels, or median distances of equal pixels where that is more
  int iterations = 30;        ///< of ICP, at most
  double kernel_width = 0.1;  ///< of ICP's Cauchy weights, as a share of the gate
  int neighbors = 10;         ///< that ICP's normals are fitted to
};

/// A session that is to be linked.
struct LinkedSession {
  const SessionPredictions& predictions;
  const PlacedSession& placed;
  double min_confidence;  ///< pixels with less are no points
};

/// The motion that brings b onto a where they share frames (times within same_frame_s): from the points of equal pixels
/// (rigid, Cauchy weights), refined by GICP of the shared frames' points at this voxel. Not linked where they share no
/// frame, fewer than min_pixels are good in both, or these determine no motion. Thread-safe.
std::variant<SessionLink, NotLinked> link_sessions(const LinkedSession& a, const LinkedSession& b, PointSource source,
                                                   double same_frame_s, double voxel_m, const LinkOptions& options);

}  // namespace cmap
