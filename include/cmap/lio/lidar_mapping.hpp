#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cmap/core/execution.hpp"
#include "cmap/core/warning.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/capture.hpp"
#include "cmap/lio/loop_closure.hpp"
#include "cmap/lio/odometry_run.hpp"

namespace cmap {

/// What odometry takes in, in the order of time; none: the end.
using LidarMessage = std::variant<LidarScan, ImuSample>;
using LidarMessages = std::function<std::optional<LidarMessage>()>;

/// Of a capture, which must outlive them: scans are read when their turn comes. Accelerations whose mean is near 1 are
/// taken for g, with a warning. Throws InputError naming file and reason: no scan, a mean acceleration that is neither
/// 1 nor 9.8 (two or more units off), and, when a scan is read, what read_lidar_scan() throws.
LidarMessages capture_messages(const Capture& capture, std::vector<Warning>& warnings);

struct MappingOptions {
  OdometryOptions odometry;
  KeyframeOptions keyframes;
  bool close_loops = true;
  std::optional<LoopOptions> loops;  ///< none: loop_options_for() the path
};

struct MappingRun {
  double duration_s = 0.0;                        ///< of the recording, for progress; 0: not known
  std::function<void(const OdometryScan&)> scan;  ///< gets every scan, as odometry has it; empty: nobody wants them
  Execution execution = {};
};

/// Where the LiDAR went, and what it saw.
struct LidarMapping {
  Trajectory scan_ends;             ///< world_T_imu at the last point of every scan, after loop closure
  Trajectory imu_stamps;            ///< and at the IMU's stamps
  std::vector<Keyframe> keyframes;  ///< at their poses by odometry
  std::vector<OdometryScan> scans;  ///< without points
  OdometrySummary summary;
  std::optional<LoopClosure> loops;  ///< none: not looked for
  LoopOptions loop_options;          ///< with which they were
  PointCloud map;                    ///< keyframes at their poses after loop closure, thinned; no color
  std::vector<Warning> warnings;
  /// Why the messages ended early; everything else is what came before. Loops are not looked for then.
  std::optional<std::string> broken_off;
};

/// Odometry, loop closure, map. Throws InputError where not one scan has a pose, saying why; what next() throws as
/// InputError after that ends the messages. Thread-safe; the same result for any number of threads.
LidarMapping map_lidar(const LidarMessages& next, const CaptureCalibration& calibration, const MappingOptions& options,
                       const MappingRun& run = {});

/// health.json: options, summary, warnings, and every scan's counts, matches, open directions and times.
nlohmann::ordered_json health_json(const LidarMapping& mapping, const MappingOptions& options);

/// What people read: scans, path, start, matches, open directions, loops, speed.
std::string mapping_table(const LidarMapping& mapping);

/// Presets of sensors, configs/lio/*.json: "aerial", "avia", "mid360", "ouster", "velodyne16", "velodyne32",
/// "velodyne64".
std::vector<std::string> odometry_preset_names();
/// Throws UsageError for others, naming them.
void apply_odometry_preset(OdometryOptions& options, const std::string& name);
/// Sets the options that a JSON file names (comments allowed). Throws UsageError naming file and key.
void apply_odometry_config_file(OdometryOptions& options, const std::filesystem::path& path);
/// "voxel_m=0.5".
void set_odometry_option(OdometryOptions& options, const std::string& assignment);

}  // namespace cmap
