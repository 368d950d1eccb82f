#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/core/warning.hpp"
#include "cmap/geometry/point_cloud.hpp"

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

}  // namespace cmap
