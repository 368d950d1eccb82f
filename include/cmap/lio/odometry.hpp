#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/core/enum_names.hpp"
#include "cmap/geometry/imu_sample.hpp"
#include "cmap/geometry/lidar_scan.hpp"
#include "cmap/geometry/trajectory.hpp"
#include "cmap/lio/odometry_options.hpp"

namespace cmap {

/// How a scan came to its pose.
enum class ScanOutcome {
  kRegistered,  ///< onto the map
  kFirst,       ///< begins the map
  kPredicted,   ///< empty, or with too few points that fit: by the IMU, or a constant velocity, alone
  kNewMap,      ///< after scans that did not fit: the map begins anew at the predicted pose
};

/// "registered", "first", "predicted", "new map".
const EnumNames<ScanOutcome>& scan_outcome_names();

/// One scan of the odometry.
struct OdometryScan {
  double time_s = 0.0;            ///< of its last point: the instant of the pose
  Eigen::Isometry3d T_world_imu;  ///< then
  Array<Eigen::Vector3f> points;  ///< in range, as seen at that instant, in the IMU's axes: motion-compensated
  Trajectory between;             ///< world_T_imu at the IMU's stamps since the scan before, this instant last
  ScanOutcome outcome = ScanOutcome::kRegistered;
  std::size_t n_measured = 0, n_points = 0, n_chosen = 0, n_matches = 0;  ///< of the scan, in range, that took part
  double rms_m = 0.0;                                                     ///< of the matches' distances to their planes
  std::vector<Eigen::Vector3d> open_shifts_world;                         ///< unit; what no surface holds
  std::vector<Eigen::Vector3d> open_turns_imu;
  double position_error_m = 0.0, rotation_error_deg = 0.0;  ///< standard deviations by the filter, the worst axes
  double cpu_s = 0.0;
};

/// What the odometry began with, and what it left out.
struct OdometrySummary {
  std::size_t n_scans = 0;         ///< with a pose
  std::size_t n_before_imu = 0;    ///< scans left out, as the IMU began later
  std::size_t n_late_scans = 0;    ///< left out: they end no later than the one before
  std::size_t n_late_samples = 0;  ///< of the IMU, likewise
  std::size_t n_imu_gaps = 0;      ///< longer than the option allows
  bool started_in_motion = false;
  double start_speed_mps = 0.0;
  Eigen::Vector3d gravity_world = Eigen::Vector3d::Zero(), gyro_bias = Eigen::Vector3d::Zero(),
                  force_bias = Eigen::Vector3d::Zero();  ///< at the end
  double path_m = 0.0;
};

/// LiDAR-inertial odometry: an iterated error-state Kalman filter of rotation, position, velocity, biases of the IMU
/// and gravity, whose measurements are distances of motion-compensated points to the planes of a voxel map (docs/
/// cmap_lio.md; Xu et al. 2022, Yuan et al. 2022). Without an IMU velocities and rates are taken for constant between
/// scans, with noise, and estimated.
///
/// Samples and scans come in any interleaving, each kind by increasing time; what is out of order is left out and
/// counted. A scan is worked on once the IMU has come to its end. Points of a scan have their own times as the sensor
/// gives them; a scan without is one instant. Serial: the same results on any machine with as many threads as it likes.
class Odometry {
 public:
  using Take = std::function<void(OdometryScan&&)>;

  /// @param T_world_start  pose at the first point of the first scan; without one the origin, heading along x, upright
  ///                       by gravity (without an IMU: the identity)
  /// Throws UsageError for options.
  Odometry(const OdometryOptions& options, const Eigen::Isometry3d& T_imu_lidar,
           const std::optional<Eigen::Isometry3d>& T_world_start, Take take);
  ~Odometry();
  Odometry(const Odometry&) = delete;
  Odometry& operator=(const Odometry&) = delete;

  void add(const ImuSample& sample);
  void add(LidarScan scan);
  /// The scans that still wait, as far as the IMU goes; after its end by prediction.
  void finish();

  OdometrySummary summary() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cmap
