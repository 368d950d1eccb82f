#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cmap/core/options.hpp"

namespace cmap {

/// What odometry depends on (docs/cmap_lio.md); defaults are those of a vehicle with a spinning sensor. Presets for
/// sensors are in configs/lio/.
struct OdometryOptions {
  // The sensor.
  double min_range_m = 1.0;  ///< nearer returns are the carrier's own
  double max_range_m = 100.0;
  double range_noise_m = 0.02;   ///< standard deviation along a beam
  double beam_noise_deg = 0.05;  ///< and across
  double model_noise_m = 0.03;   ///< of surfaces that are no plane, and of what deskewing leaves

  // The map.
  double voxel_m = 1.0;             ///< largest cell
  int levels = 3;                   ///< cells that are no plane are halved, that many sizes in all
  double plane_thickness_m = 0.05;  ///< most standard deviation across a plane
  double cell_points = 100;         ///< a cell's plane is settled once it has as many
  double forget_after_m = 300.0;    ///< of path: cells unseen for longer begin anew

  // A scan.
  double scan_voxel_m = 1.0;    ///< points of a scan are thinned to this for registration
  int scan_points = 2000;       ///< at most as many take part
  double insert_voxel_m = 0.2;  ///< and to this for the map
  int iterations = 15;
  double gate = 3.0;  ///< standard deviations

  // The IMU.
  double gyro_noise = 2e-3;       ///< rad/s/sqrt(Hz)
  double force_noise = 5e-2;      ///< m/s^2/sqrt(Hz)
  double gyro_bias_walk = 1e-4;   ///< rad/s^2/sqrt(Hz)
  double force_bias_walk = 1e-3;  ///< m/s^3/sqrt(Hz)
  double free_rate = 0.15;        ///< rad/s/sqrt(Hz): of a rate that is guessed, in gaps of the IMU
  double free_turn = 0.7;         ///< rad/s^2/sqrt(Hz): how a rate changes without an IMU
  double free_force = 2.0;        ///< m/s^2/sqrt(Hz): how a velocity changes without an IMU
  double max_imu_gap_s = 0.05;    ///< longer gaps are guessed over
  bool use_imu = true;
};

/// Each of them by its name. The options must outlive the list.
OptionFields option_fields(OdometryOptions& options);

}  // namespace cmap
