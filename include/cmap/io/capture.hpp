#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cmap/core/warning.hpp"
#include "cmap/geometry/camera_model.hpp"
#include "cmap/geometry/imu_sample.hpp"
#include "cmap/geometry/trajectory.hpp"
#include "cmap/io/faults.hpp"

namespace cmap {

struct LidarScan;
struct SessionPredictions;

/// A file that belongs to a time; the path is ready to open.
struct StampedFile {
  double time_s = 0.0;
  std::filesystem::path path;
};

/// What capture.json says. T_a_b maps coordinates in b to a.
struct CaptureCalibration {
  CameraModel camera;
  Eigen::Isometry3d T_imu_lidar = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_lidar_camera = Eigen::Isometry3d::Identity();
  std::optional<Eigen::Isometry3d> T_world_imu_start;  ///< where odometry begins; none: see Odometry
  /// Of images and of sessions' frames: recorded time + offset = time in the clock of the LiDAR.
  double image_time_offset_s = 0.0;
  double imu_time_offset_s = 0.0;  ///< likewise
};

/// A capture (FORMATS, "Captures"), opened: calibration, tables, IMU and poses are read and checked; images, scans
/// and predictions are files that are there, read when they are needed.
struct Capture {
  std::filesystem::path folder;
  CaptureCalibration calibration;
  std::vector<StampedFile> images, scans;       ///< by increasing time, offsets applied
  std::vector<ImuSample> imu;                   ///< by increasing time, offset applied; empty: none
  Trajectory lio;                               ///< world_T_imu; empty: none
  std::vector<std::filesystem::path> sessions;  ///< for read_session_predictions, by name; empty: none
  std::vector<Warning> warnings;                ///< what was decided on the user's behalf
};

/// Whether a part of a capture is read.
enum class Want {
  kNo,        ///< not looked at
  kIfUsable,  ///< left out where it is missing, and with a warning where it is faulty; with a list of faults, each is a
              ///< warning, and what could be read stays
  kYes,
};

/// The parts of a capture that not everybody needs. To have no IMU, poses or sessions is no fault either way.
struct CaptureParts {
  Want images = Want::kYes, scans = Want::kYes, imu = Want::kYes, sessions = Want::kYes;
};

/// Opens a capture, or a drive of KITTI's raw data as one (FORMATS, "KITTI drives"); one whose images and sessions are
/// not wanted needs no camera. Rotations that deviate from one (largest entry of R^T R - I) are projected to SO(3),
/// with a warning above 1e-3. Throws InputError naming file, place and reason: a file that is missing (images and scans
/// of the tables too), an unknown or missing key, a matrix that is no rotation and translation (det R <= 0, or beyond
/// 0.2), times that do not increase, one frames.csv beside several NPZ files. With a list of faults it goes on after
/// each of these, with what could be read. Thread-safe.
Capture open_capture(const std::filesystem::path& folder, const CaptureParts& parts = {}, const Faults& faults = {});

/// The predictions of a session (read_session_predictions()), its frames' times in the clock of the LiDAR.
SessionPredictions read_session(const Capture& capture, std::size_t session, const Faults& faults = {});

/// Writes a capture, which appears under its name only when commit() says it is complete: until then everything goes to
/// `<folder>.partial`, which open_capture does not take for a capture (see OutputFolder). Images and scans come by
/// increasing time, each as soon as there is one; the rest once, in any order. Times are those of Capture: where the
/// calibration has an offset, what is recorded is the time without it. Not thread-safe. Every failure to write is an
/// OutputError that names path and reason; wrong use (times that do not increase) std::invalid_argument.
class CaptureWriter {
 public:
  CaptureWriter(const std::filesystem::path& folder, const CaptureCalibration& calibration);
  ~CaptureWriter();
  CaptureWriter(const CaptureWriter&) = delete;
  CaptureWriter& operator=(const CaptureWriter&) = delete;

  /// Lists an image and says where the caller must write it; `extension` is ".jpg" or ".png".
  std::filesystem::path add_image(double time_s, const std::string& extension);
  /// Lists a scan of its timestamp_s and writes it.
  void add_scan(const LidarScan& scan);
  void write_imu(std::span<const ImuSample> samples);
  void write_lio(const Trajectory& world_T_imu);
  /// Writes predictions/session_0000, session_0001, ...
  void add_session(const SessionPredictions& session);
  /// A folder of this name in the capture ("truth"), made if need be, for files of the caller.
  std::filesystem::path subfolder(const std::string& name);
  /// Throws UsageError if an image was listed and not written.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cmap
