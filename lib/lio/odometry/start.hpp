#pragma once

#include <optional>
#include <span>

#include "cmap/geometry/imu_sample.hpp"
#include "cmap/lio/odometry_options.hpp"
#include "filter/nav_state.hpp"
#include "odometry/scan_points.hpp"

namespace cmap {

/// Where and how fast odometry begins.
struct Start {
  NavState state;  ///< at the end of the first scan
  StateMatrix covariance;
  NavState at_begin;  ///< at its first point
  bool in_motion = false;
};

/// Finds how the body moves at the start from two scans: registered as they are, deskewed both with the motion found,
/// registered again, three times (GICP). At rest, rates and forces of the IMU give its bias and gravity; in motion
/// gravity is the mean force, and known as well as that.
/// @param imu  samples from before the first scan until the end of the second; empty: without an IMU, in whose place
///             the gyro's bias is the negative rate of turn
Start find_start(const ScanPoints& first, const ScanPoints& second, std::span<const ImuSample> imu,
                 const Eigen::Isometry3d& T_imu_lidar, const std::optional<Eigen::Isometry3d>& T_world_start,
                 const OdometryOptions& options);

/// The same of a sensor with nothing but one scan: at rest.
Start start_at_rest(const ScanPoints& first, std::span<const ImuSample> imu,
                    const std::optional<Eigen::Isometry3d>& T_world_start);

}  // namespace cmap
