#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "cmap/geometry/imu_sample.hpp"
#include "cmap/sim/pose_spline.hpp"

namespace cmap {

/// An inertial measurement unit at the body's origin, axes as the body's. Defaults: Bosch BMI088, the one in the Livox
/// Avia, by its data sheet where it gives the number (noise densities).
struct ImuOptions {
  double rate_hz = 200.0;
  double gyro_noise_density_radps_per_sqrt_hz = 2.4e-4;          ///< 0.014 deg/s/sqrt(Hz)
  double accelerometer_noise_density_mps2_per_sqrt_hz = 1.7e-3;  ///< 175 ug/sqrt(Hz)
  double gyro_bias_walk_radps2_per_sqrt_hz = 2e-5;               ///< rate random walk: sigma after 1 s
  double accelerometer_bias_walk_mps3_per_sqrt_hz = 1e-4;
  double gyro_bias_radps = 2e-3;  ///< standard deviation per axis of the bias at the first sample
  double accelerometer_bias_mps2 = 2e-2;
  double gravity_mps2 = 9.81;                                           ///< along -z of the world
  Eigen::Vector3d accelerometer_lever_arm_m = Eigen::Vector3d::Zero();  ///< of the accelerometer from the body's origin
};

/// What an ideal unit measures: the body's angular rate, and specific force R^T (a + g z) with the acceleration of the
/// place of the accelerometer. At rest and level: 0, and +g along z.
ImuSample ideal_imu_sample(const Motion& motion, double time_s, const ImuOptions& options);

/// Samples from the path's start to its end, with noise: white noise of standard deviation density * sqrt(rate), and a
/// bias that is a random walk with steps of standard deviation walk / sqrt(rate). Densities of 0: ideal samples.
/// Throws UsageError naming an option that is out of range.
std::vector<ImuSample> simulate_imu(const PoseSpline& path, const ImuOptions& options, std::uint64_t seed);

}  // namespace cmap
