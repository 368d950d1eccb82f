#include "cmap/colorize/posed_images.hpp"

#include <fmt/format.h>

#include "cmap/align/pose_pairs.hpp"
#include "cmap/core/error.hpp"

namespace cmap {
namespace {

[[noreturn]] void fail_without_poses(const Capture& capture, const Trajectory& poses,
                                     const PosedImageOptions& options) {
  throw InputError(fmt::format(
      "{}: no image has a pose at its time: images from {:.3f} to {:.3f} s{}, poses from {:.3f} to {:.3f} s, gaps of "
      "at most {:g} s",
      capture.folder.string(), capture.images.front().time_s, capture.images.back().time_s,
      options.time_offset_s == 0.0 ? "" : fmt::format(" and {:+g} s", options.time_offset_s), poses.front().time_s,
      poses.back().time_s, options.max_gap_s));
}

}  // namespace

PosedCapture posed_images(const Capture& capture, const Trajectory& world_T_imu, const PosedImageOptions& options) {
  const ImageSubset& subset = options.subset;
  if (subset.stride < 1) throw UsageError("image stride is 0; at least 1 expected");
  if (capture.images.empty()) throw InputError(fmt::format("{}: no images", capture.folder.string()));
  if (world_T_imu.empty()) {
    throw InputError(fmt::format("{}: no poses: lio.tum, or a trajectory of its own", capture.folder.string()));
  }
  if (subset.offset >= capture.images.size()) {
    throw UsageError(fmt::format("image offset is {}; below the number of images, {}, expected", subset.offset,
                                 capture.images.size()));
  }
  PosedCapture posed;
  posed.images.camera = capture.calibration.camera;
  posed.images.T_lidar_camera = capture.calibration.T_lidar_camera;
  for (std::size_t i = subset.offset; i < capture.images.size(); i += subset.stride) {
    const StampedFile& file = capture.images[i];
    const double time_s = file.time_s + options.time_offset_s;
    ++posed.n_chosen;
    const auto body = pose_at(world_T_imu, time_s, options.max_gap_s);
    if (!body) continue;
    const Eigen::Isometry3d T_world_imu = Eigen::Translation3d(body->position) * body->rotation;
    posed.images.list.push_back(
        {i, file.path.filename().string(), time_s, T_world_imu * capture.calibration.T_imu_lidar});
  }
  posed.n_without_pose = posed.n_chosen - posed.images.list.size();
  if (posed.images.list.empty()) fail_without_poses(capture, world_T_imu, options);
  return posed;
}

}  // namespace cmap
