#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cmap/geometry/lidar_scan.hpp"
#include "cmap/sim/pose_spline.hpp"
#include "cmap/sim/scene.hpp"

namespace cmap {

enum class LidarPattern {
  kSpinning,     ///< one turn per scan, clockwise from above, all lines fire one after another at every azimuth step
  kAviaRosette,  ///< two prisms, six lines: Livox Avia, non-repetitive mode
  kMid360,       ///< all around, four lines that swing up and down: Livox Mid-360
};

/// A LiDAR; x forward, y left, z up. The defaults are those of lidar_model("spinning_16").
struct LidarOptions {
  LidarPattern pattern = LidarPattern::kSpinning;
  double scan_rate_hz = 10.0;
  std::vector<double> elevations_deg;  ///< spinning: of the lines; line i is ring i
  int azimuth_steps = 1800;            ///< spinning: per turn
  double start_azimuth_deg = 180.0;    ///< spinning: of a scan's first step, so that its middle looks forward
  int points_per_s = 240000;           ///< rosettes

  double range_noise_m = 0.02;     ///< standard deviation
  double angular_noise_deg = 0.0;  ///< standard deviation of the beam about its stated direction, per axis
  double min_range_m = 0.5;        ///< blind zone
  double max_range_m = 100.0;
  /// A surface of reflectivity 0.1 seen head-on at this range is lost half of the time. A return's power goes with
  /// reflectivity cos(incidence) / range^2; it is detected with probability 1 / (1 + power^-steepness), power 1 there.
  double half_detection_range_m = 100.0;
  double detection_steepness = 3.0;
  double lost_fraction = 0.0;  ///< of all returns, whatever the surface
  bool lossless = false;       ///< every surface within range answers, except water: the three options above are off
};

/// Options of a sensor as its data sheet has them: "spinning_16" (Velodyne VLP-16), "spinning_32" (HDL-32E),
/// "spinning_64" (HDL-64E), "avia", "mid360". Throws UsageError for another name.
LidarOptions lidar_model(const std::string& name);
std::vector<std::string> lidar_model_names();

/// One shot of the sensor.
struct LidarBeam {
  Eigen::Vector3d direction;  ///< unit, LiDAR frame
  float time_s;               ///< from the start of the scan
  std::uint16_t line;
};

/// Shots of one scan.
std::size_t beams_per_scan(const LidarOptions& options);

/// Shot `i` of the scan that starts at `start_s`.
///
/// Spinning: step k of `azimuth_steps` N, line l of L: azimuth = start - 360 deg (k + l / L) / N.
/// Avia: with its offset from the axis as a vector (left, up) of angles, line l of six, t the time since 0:
///   17.6 deg [cos, sin](2 pi 121.57 Hz t) + 17.6 deg [cos, sin](-2 pi 77.73 Hz t) + (0, (l - 2.5) 1.36 deg),
/// the field of view of the data sheet, 70.4 x 77.2 deg, in the petals of a pair of equal prisms; speeds (7294 and
/// -4664 rpm) of the older Mid-40: those of the Avia are not published. The pattern repeats after 30 s.
/// Mid-360, line l of four: azimuth 360 deg 10.18 Hz t, elevation 22.5 + 29.5 deg sin(2 pi (217.67 Hz t + l / 4)):
/// the data sheet's -7..52 deg; 21.382 swings per turn (golden section), so that turns fall between earlier ones. The
/// true mechanism is not published; the shape is a stand-in with its field of view, rate, lines and growth of coverage.
LidarBeam lidar_beam(const LidarOptions& options, double start_s, std::size_t i);

/// A scan along the path: every shot from where the LiDAR is at the shot's own time, its point in the LiDAR frame at
/// that time. Points in the order of time; intensity = 255 reflectivity cos(incidence), whole; ring = line. Without
/// noise and losses every point is exactly on the scene, to the rounding of float.
/// Throws std::out_of_range where the scan reaches beyond the path, UsageError naming an option that is out of range.
LidarScan simulate_scan(const Scene& scene, const PoseSpline& T_world_imu, const Eigen::Isometry3d& T_imu_lidar,
                        const LidarOptions& options, double start_s, std::uint64_t seed);

}  // namespace cmap
