#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/core/warning.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/faults.hpp"

namespace cmap {

/// Which picture a frame of a session was made from.
struct PredictionFrame {
  std::size_t index = 0;  ///< in the session
  double time_s = 0.0;
  std::string image_name;
  int original_width = 0, original_height = 0;  ///< pixels, before it was resized for the network
};

/// One VGGT call: S frames of width x height pixels, in the session's own unit of length. Arrays are row-major
/// [frame][row][column]. The session frame is the camera of frame 0.
struct SessionPredictions {
  int width = 0, height = 0;
  std::vector<PredictionFrame> frames;  ///< by increasing time
  Array<Rgb8> images;
  Array<float> depth;                               ///< along the optical axis, > 0; 0 where there is none
  Array<float> depth_confidence;                    ///< VGGT's are >= 1; 0 where there is no depth
  std::vector<Eigen::Isometry3d> T_camera_session;  ///< OpenCV: x right, y down, z forward; that of frame 0 is identity
  Eigen::Isometry3d T_session_file = Eigen::Isometry3d::Identity();  ///< from the frame that the file's poses are in
  std::vector<Eigen::Matrix3d> intrinsics;  ///< upper triangular, last row 0 0 1; pixel centers at integers
  Array<Eigen::Vector3f> world_points;      ///< session frame; empty: none
  Array<float> world_points_confidence;     ///< 0 where there is no point; empty: no points
  std::vector<Warning> warnings;            ///< what was decided on the user's behalf

  std::size_t frame_count() const { return frames.size(); }
  std::size_t pixels_per_frame() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Reads a session in either form of FORMATS: a folder with meta.json, frames.csv and the arrays, or VGGT's own
/// NAME.npz with NAME.frames.csv beside it, or frames.csv where no other NPZ file is (a folder may hold these two as
/// well).
///
/// Rotations are projected to SO(3), and everything is moved so that frame 0's camera is the session frame (a warning
/// where it was not nearly so). Pixels whose depth or confidence is zero or not finite get depth and confidence 0, with
/// a warning that counts them; so do points. Picture values a little outside [0,1] are clamped, with a warning that
/// counts them. Confidences below 1 and skipped members are warnings.
/// Throws InputError naming file, member and reason: anything missing or malformed, shapes or numbers of frames that
/// differ, a rotation beyond 1e-3, intrinsics of a picture of another size, a negative depth, a session without a
/// single valid pixel, times not increasing, a convention other than FORMATS'. With a list of faults it goes on after
/// each of these; what it returns is then whole only where none was added. Thread-safe.
SessionPredictions read_session_predictions(const std::filesystem::path& folder_or_npz, const Faults& faults = {});

/// Writes the folder form, whole or not at all; the folder must not exist. Depth as float32, poses as float64; times
/// are recorded without `time_offset_s`. Throws UsageError if it cannot be written or a name cannot stand in
/// frames.csv, std::invalid_argument if sizes differ.
void write_session_predictions(const SessionPredictions& session, const std::filesystem::path& folder,
                               double time_offset_s = 0.0);

/// A keyframe of VGGT-SLAM: a point per pixel in a frame and unit common to all keyframes.
struct PointMap {
  double time_s = 0.0;        ///< the file's name
  int width = 0, height = 0;  ///< height 1 where the file does not keep the picture's shape
  Array<Eigen::Vector3f> points;
  Array<std::uint8_t> mask;  ///< 1: valid, and then finite
};

/// Reads `<stamp>.npz` with pointcloud (H,W,3) or (N,3) and mask (H,W) or (N,). Throws InputError naming file, member
/// and reason.
PointMap read_point_map(const std::filesystem::path& npz);

}  // namespace cmap
