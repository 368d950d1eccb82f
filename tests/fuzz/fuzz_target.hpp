#pragma once

#include <Eigen/LU>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "captures/capture_json.hpp"
#include "captures/session_arrays.hpp"
#include "clouds/cloud_format.hpp"
#include "cmap/core/error.hpp"
#include "poses/trajectory_rows.hpp"
#include "poses/transform_numbers.hpp"

namespace cmap::fuzz {

/// One input for one format's reader, which must read it or refuse it. The small blocks of a source in memory make the
/// input cross their borders.
inline void try_reader(const CloudFormat& format, std::span<const std::byte> input, const ReadOptions& options) {
  try {
    ByteSource source("input", input);
    FileInfo info;
    const PointCloud cloud = format.read(source, info, options);
    if (cloud.size() != info.finite_points || cloud.size() == 0) __builtin_trap();
    for (const Eigen::Vector3f& p : cloud.positions) {
      if (!p.allFinite()) __builtin_trap();
    }
  } catch (const UnsupportedError&) {
    // so is what cannot be used
  } catch (const InputError&) {
    // a refusal is an answer
  }
}

inline void try_format(const CloudFormat& format, std::span<const std::byte> input) {
  try_reader(format, input, {});
  if (format.has_classes) try_reader(format, input, {.classes = {0, 2}});
}

/// Whatever the content says it is.
inline void try_any(std::span<const std::byte> input) {
  const CloudFormat* format = nullptr;
  try {
    ByteSource source("input", input);
    format = &detect_format(source);
  } catch (const InputError&) {
    return;
  }
  try_reader(*format, input, {});
}

/// A session's arrays in an NPZ file, which must be read or refused, and then hold nothing but numbers.
inline void try_session(std::span<const std::byte> input) {
  try {
    const ArrayStore store("input", input);
    SessionPredictions session;
    std::size_t frames = 0;
    read_depth(store, session, frames);
    read_images(store, session, frames);
    read_world_points(store, session, frames);
    read_intrinsics(store, session, frames);
    read_poses(store, session, frames);
    make_first_camera_the_frame(store, session);
    const std::size_t pixels = frames * session.pixels_per_frame();
    if (session.depth.size() != pixels || session.images.size() != pixels) __builtin_trap();
    for (const float depth : session.depth) {
      if (!(depth >= 0.0F && depth <= std::numeric_limits<float>::max())) __builtin_trap();
    }
    for (const Eigen::Isometry3d& pose : session.T_camera_session) {
      if (!pose.linear().isUnitary(1e-9)) __builtin_trap();
    }
  } catch (const InputError&) {
    // a refusal is an answer
  }
}

/// The text of a capture.json.
inline void try_capture(std::span<const std::byte> input) {
  try {
    const std::string text(reinterpret_cast<const char*>(input.data()), input.size());
    const CaptureCalibration calibration = parse_capture_json(text, "input").calibration;
    const CaptureCalibration copy = parse_capture_json(capture_json(calibration), "copy").calibration;
    if (!copy.T_imu_lidar.matrix().isApprox(calibration.T_imu_lidar.matrix(), 1e-12)) __builtin_trap();
    if (copy.camera.distortion != calibration.camera.distortion) __builtin_trap();
  } catch (const InputError&) {
    // a refusal is an answer
  }
}

/// A transform, which is a rotation times a positive scale with a translation.
inline void try_transform(std::span<const std::byte> input) {
  try {
    ByteSource source("input", input);
    const Eigen::Matrix4d T = parse_transform(source).T;
    if (!T.allFinite() || T.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) __builtin_trap();
    if (!(T.topLeftCorner<3, 3>().determinant() > 0.0)) __builtin_trap();
  } catch (const InputError&) {
    // a refusal is an answer
  }
}

/// Poses, whose times increase where there are any.
inline void try_trajectory(std::span<const std::byte> input) {
  try {
    ByteSource source("input", input);
    const TrajectoryFile file = parse_trajectory(source);
    if (file.poses.empty() || file.rows < file.poses.size()) __builtin_trap();
    for (std::size_t i = 0; i < file.poses.size(); ++i) {
      const StampedPose& pose = file.poses[i];
      if (!std::isfinite(pose.time_s) || !pose.position.allFinite()) __builtin_trap();
      if (!(std::abs(pose.rotation.norm() - 1.0) < 1e-9)) __builtin_trap();
      if (i > 0 && !(pose.time_s > file.poses[i - 1].time_s)) __builtin_trap();
    }
  } catch (const InputError&) {
    // a refusal is an answer
  }
}

}  // namespace cmap::fuzz
