#pragma once

#include <cstdint>
#include <span>

#include "cmap/lio/odometry_options.hpp"
#include "map/plane_map.hpp"
#include "odometry/degeneracy.hpp"
#include "odometry/motion_track.hpp"
#include "odometry/scan_points.hpp"

namespace cmap {

struct ScanRegistration {
  NavState state;  ///< at the scan's end
  StateMatrix covariance;
  std::size_t n_points = 0;   ///< that took part
  std::size_t n_matches = 0;  ///< of them, with a plane
  double rms_m = 0.0;         ///< of the matches' distances to their planes
  OpenDirections open;
  int iterations = 0;
};

/// Registers a scan to planes: an iterated Kalman update, the scan deskewed with each new estimate. `chosen` are the
/// points that take part.
ScanRegistration register_scan(const PlaneMap& map, const ScanPoints& scan, std::span<const std::uint32_t> chosen,
                               const MotionTrack& track, const StateMatrix& predicted_covariance,
                               const Eigen::Isometry3d& T_body_lidar, const OdometryOptions& options);

/// Variance of a point's distance to a surface with that normal; `point` from the sensor, the normal in its axes. Along
/// the beam by the range's noise, across by the beam's.
double point_variance_m2(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, const OdometryOptions& options);

}  // namespace cmap
