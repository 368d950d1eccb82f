#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "cmap/geometry/camera_model.hpp"
#include "cmap/geometry/rgb_image.hpp"
#include "cmap/geometry/trajectory.hpp"
#include "cmap/io/capture.hpp"

namespace cmap {

/// An image whose pose is known.
struct PosedImage {
  std::size_t index = 0;                                            ///< in the capture's table
  std::string name;                                                 ///< of its file, for people
  double time_s = 0.0;                                              ///< in the clock of the LiDAR
  Eigen::Isometry3d T_world_lidar = Eigen::Isometry3d::Identity();  ///< at that time
};

/// Images of one camera along known poses. They are read when they are needed: `read` gives the one at a place of the
/// list, of the camera's size; it is called from several threads at once. A function, and not a file, so that this
/// module needs no decoder (OpenCV's is in cmap::images), and that frames of a recording may come from anywhere.
struct PosedImages {
  CameraModel camera;
  Eigen::Isometry3d T_lidar_camera = Eigen::Isometry3d::Identity();
  std::vector<PosedImage> list;  ///< by increasing time
  std::function<RgbImage(std::size_t place)> read;

  Eigen::Isometry3d T_world_camera(std::size_t place) const { return list[place].T_world_lidar * T_lidar_camera; }
};

/// Which images of a capture are taken: those of its table at offset, offset + stride, ...
struct ImageSubset {
  std::size_t stride = 1, offset = 0;
};

struct PosedImageOptions {
  ImageSubset subset = {};
  double time_offset_s = 0.0;  ///< added to the images' times, beside the calibration's own
  double max_gap_s = 0.15;     ///< poses farther apart are not interpolated between
};

/// The images of a capture that have a pose at their time, interpolated between world_T_imu, and how many have none.
/// `read` is the caller's to set. Throws InputError naming the capture and both spans of time where there is no image,
/// no pose, or no image has one; UsageError unless stride >= 1 and an image is in the subset. Thread-safe.
struct PosedCapture {
  PosedImages images;
  std::size_t n_chosen = 0;  ///< images of the subset
  std::size_t n_without_pose = 0;
};
PosedCapture posed_images(const Capture& capture, const Trajectory& world_T_imu, const PosedImageOptions& options);

}  // namespace cmap
