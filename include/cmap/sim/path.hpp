#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "cmap/sim/pose_spline.hpp"

namespace cmap {

/// Corners of a way through the scene, world frame, m.
using Route = std::vector<Eigen::Vector3d>;

/// From `start` in the direction `heading_deg` (counterclockwise from x).
Route straight_route(const Eigen::Vector3d& start, double heading_deg, double length_m);

/// Around a block, counterclockwise from the corner `min`, at height z; goes on past the start by `overlap_m`, so that
/// a loop can be closed.
Route block_route(const Eigen::Vector2d& min, const Eigen::Vector2d& max, double z_m, double overlap_m);

/// Parallel lines along x, out and back, `line_distance_m` apart in y, covering the box: a survey from the air.
Route survey_route(const Eigen::Vector2d& min, const Eigen::Vector2d& max, double z_m, double line_distance_m);

/// The route laid `height_m` above the ground: corners every `step_m` at most, each at ground(x, y) + height_m.
/// Throws std::invalid_argument where step_m is not above 0.
using GroundHeight = std::function<double(double x, double y)>;
Route draped_route(const Route& route, const GroundHeight& ground, double height_m, double step_m = 1.0);

/// How a body (its x forward, z up) moves along a route.
struct PathOptions {
  double rest_s = 3.0;            ///< still at the start, for the sensors' initialization
  double ramp_s = 2.0;            ///< from rest to the full speed, and back at the end
  double speed_mps = 1.5;         ///< lowered where the route is shorter than both ramps
  double hold_s = 0.0;            ///< stays at the end, swaying: a hover on a route of one corner
  double corner_m = 3.0;          ///< corners are rounded off over this length before and after
  double heading_offset_deg = 0;  ///< of the body against the way it goes
  bool turn_with_route = true;    ///< false: always heads for heading_offset_deg (a survey that keeps its attitude)

  double sway_position_m = 0.0;  ///< standard deviation per axis of the way the body swings about the route
  double sway_roll_deg = 0.0;    ///< the same of the angles
  double sway_pitch_deg = 0.0;
  double sway_yaw_deg = 0.0;
  double sway_frequency_hz = 0.5;  ///< middle of the three frequencies of every sway

  double knot_spacing_s = 0.1;  ///< of the spline; shorter than a quarter of a sway's period
  double start_time_s = 0.0;    ///< stamp of the first moment
};

/// The motion of a body along a route: at rest, exactly, for rest_s, then on its way, then holding. Throws UsageError
/// naming an option that is out of range, std::invalid_argument where the route has no corner.
PoseSpline make_path(const Route& route, const PathOptions& options, std::uint64_t seed);

}  // namespace cmap
