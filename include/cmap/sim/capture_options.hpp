#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cmap/geometry/camera_model.hpp"
#include "cmap/sim/imu.hpp"
#include "cmap/sim/lidar.hpp"
#include "cmap/sim/path.hpp"
#include "cmap/sim/predictions.hpp"
#include "cmap/sim/scene.hpp"

namespace cmap {

enum class SceneKind { kTown, kIndoor, kAerial, kMesh };

/// Which scene; only the options of its kind count.
struct SceneChoice {
  SceneKind kind = SceneKind::kTown;
  int seed = 1;  ///< of the scene: another seed of the capture keeps it
  TownOptions town;
  IndoorOptions indoor;
  AerialOptions aerial;
  std::string mesh;  ///< file of a mesh scene
};

enum class RouteKind {
  kScene,     ///< a way of the scene, by name
  kStraight,  ///< from start_m, heading_deg, length_m
  kBlock,     ///< around the box from min_m to max_m
  kSurvey,    ///< lines over that box
  kHover      ///< stays at start_m for path.hold_s
};

/// Where the sensors are carried along.
struct RouteChoice {
  RouteKind kind = RouteKind::kScene;
  std::string name = "street";  ///< of a way of the scene; a closed one goes on past its start by overlap_m
  double height_m = 1.6;        ///< above the way of the scene (0 for its "survey"), or above the ground
  double begin_m = 0.0;         ///< left out at the way's beginning
  double length_m = 0.0;        ///< of the way; 0: all of it (a straight way needs one)
  Eigen::Vector2d start_m = Eigen::Vector2d::Zero();
  double heading_deg = 0.0;
  Eigen::Vector2d min_m = Eigen::Vector2d::Zero(), max_m = Eigen::Vector2d::Zero();
  double overlap_m = 0.0;
  double line_distance_m = 30.0;
};

/// How LiDAR and camera are mounted. Angles turn about z (yaw), then the new y (pitch), then the new x (roll).
struct MountOptions {
  Eigen::Vector3d lidar_translation_m{0.0, 0.0, 0.1};  ///< of the LiDAR in the IMU's frame
  Eigen::Vector3d lidar_roll_pitch_yaw_deg = Eigen::Vector3d::Zero();
  Eigen::Vector3d camera_translation_m{0.1, 0.0, -0.1};  ///< of the camera in the LiDAR's frame
  /// Of the camera's forward, left, up against the LiDAR's axes.
  Eigen::Vector3d camera_roll_pitch_yaw_deg = Eigen::Vector3d::Zero();
};

enum class PictureFormat { kJpg, kPng };

/// The camera and its pictures.
struct CameraOptions {
  CameraProjection projection = CameraProjection::kPinhole;
  int width_px = 1036, height_px = 776;
  double focal_px = 720.0;
  Eigen::Vector2d center_offset_px = Eigen::Vector2d::Zero();  ///< of the principal point from (width/2, height/2)
  std::vector<double> distortion;
  double rate_hz = 2.0;
  double phase_s = 0.05;  ///< of the first picture after begin_s: in the middle of a scan at 10 Hz
  double begin_s = 0.0;   ///< no pictures before, from the start of the path
  int supersampling = 2;
  double vignetting = 0.0;
  double exposure_noise = 0.0;  ///< standard deviation of the logarithm of a picture's gain
  double pixel_noise_u8 = 0.0;  ///< standard deviation of a pixel's channel, of 255
  PictureFormat format = PictureFormat::kJpg;
};

/// What the capture says that is not so, for experiments on what follows.
struct StatedOptions {
  Eigen::Vector3d camera_rotation_error_deg = Eigen::Vector3d::Zero();   ///< rotation vector, camera's frame
  Eigen::Vector3d camera_translation_error_m = Eigen::Vector3d::Zero();  ///< LiDAR's frame
  double image_time_error_s = 0.0;        ///< added to the stamps of images and predictions
  bool lio = true;                        ///< writes lio.tum: poses at the first scan's start and at every scan's end
  double lio_drift_m_per_sqrt_m = 0.002;  ///< standard deviation per axis after 1 m of way: a random walk
  double lio_drift_deg_per_sqrt_m = 0.003;
};

/// What is kept of the truth.
struct TruthOptions {
  double map_points_per_m2 = 100.0;  ///< of truth/map.ply: surfaces that some picture saw
  double map_max_distance_m = 60.0;  ///< from the camera
  double trajectory_rate_hz = 100.0;
};

/// Everything that makes a simulated capture.
struct CaptureOptions {
  int seed = 1;                 ///< of all noise and sway
  double max_duration_s = 0.0;  ///< ends earlier than the path; 0: no
  SceneChoice scene;
  RouteChoice route;
  PathOptions path;
  ImuOptions imu;
  LidarOptions lidar = lidar_model("spinning_16");
  MountOptions mount;
  CameraOptions camera;
  PredictionOptions predictions;
  StatedOptions stated;
  TruthOptions truth;
};

/// Applies the JSON of a configuration (comments allowed): an object with the members of CaptureOptions by name, each
/// an object with the fields by name; lidar.model sets all of the LiDAR first. What is not named stays. Throws
/// UsageError naming `source`, section and key: unknown, of a wrong type, out of range.
void apply_capture_config(CaptureOptions& options, const std::string& json_text, const std::string& source);
void apply_capture_config_file(CaptureOptions& options, const std::filesystem::path& path);

/// Applies "section.field=value" (or "seed=2"); the value as JSON, or a plain word. Throws UsageError likewise.
void set_capture_option(CaptureOptions& options, const std::string& assignment);

/// The shipped configurations of configs/sim/: "town", "indoor", "aerial", and a small one of each for tests,
/// "small_town", "small_indoor", "small_aerial".
std::vector<std::string> capture_preset_names();
void apply_capture_preset(CaptureOptions& options, const std::string& name);

/// All options, by name: apply_capture_config() of it gives the same options.
nlohmann::ordered_json to_json(const CaptureOptions& options);

/// What the sensors truly are.
CameraModel camera_of(const CameraOptions& options);
Eigen::Isometry3d T_imu_lidar_of(const MountOptions& options);
Eigen::Isometry3d T_lidar_camera_of(const MountOptions& options);

}  // namespace cmap
