#pragma once

#include <span>
#include <string>

#include "cmap/geometry/imu_sample.hpp"
#include "cmap/geometry/trajectory.hpp"

namespace cmap {

/// What is wrong with the order of the quaternions of poses, by gravity: the IMU's mean force, in the world of the
/// poses, points up. Empty where it does, or where the other order does not say better.
std::string quaternion_order_fault(const Trajectory& world_T_imu, std::span<const ImuSample> imu);

}  // namespace cmap
