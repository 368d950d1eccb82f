#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace cmap {

/// Where something is and how it moves: what an ideal inertial sensor measures follows from it.
struct Motion {
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();                 ///< world
  Eigen::Vector3d acceleration_mps2 = Eigen::Vector3d::Zero();            ///< world, without gravity
  Eigen::Vector3d angular_rate_radps = Eigen::Vector3d::Zero();           ///< body
  Eigen::Vector3d angular_acceleration_radps2 = Eigen::Vector3d::Zero();  ///< body
};

/// A smooth path of a body: positions are a uniform cubic B-spline, rotations a uniform cumulative cubic B-spline on
/// SO(3) (Kim, Kim, Shin 1995), both twice continuously differentiable; derivatives are exact, by the recursion of
/// Sommer et al., "Efficient derivative computation for cumulative B-splines on Lie groups" (CVPR 2020).
/// The spline runs near its control poses, not through them: it is the truth itself. Immutable, thread-safe.
class PoseSpline {
 public:
  /// Control pose i belongs to the time start_s + (i - 1) spacing_s; the spline covers all but the first and the last
  /// interval. Throws std::invalid_argument on fewer than 4 controls, a spacing that is not above 0, or neighboring
  /// rotations 180 degrees apart (their way would be arbitrary).
  PoseSpline(double start_s, double spacing_s, const std::vector<Eigen::Isometry3d>& T_world_body_controls);

  double start_s() const { return start_s_; }
  double end_s() const { return start_s_ + spacing_s_ * static_cast<double>(rotations_.size() - 3); }

  /// Throw std::out_of_range outside [start_s, end_s].
  Eigen::Isometry3d pose(double time_s) const;
  Motion motion(double time_s) const;
  Eigen::Vector3d velocity(double time_s) const { return motion(time_s).velocity_mps; }
  Eigen::Vector3d acceleration(double time_s) const { return motion(time_s).acceleration_mps2; }
  Eigen::Vector3d angular_rate_body(double time_s) const { return motion(time_s).angular_rate_radps; }

 private:
  struct Place {
    std::size_t first;  ///< of the four controls
    double u;           ///< in [0,1]
  };
  Place place(double time_s) const;

  double start_s_, spacing_s_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Quaterniond> rotations_;
  std::vector<Eigen::Vector3d> steps_;  ///< rotation vector from control i to i + 1, in the frame of i
};

}  // namespace cmap
