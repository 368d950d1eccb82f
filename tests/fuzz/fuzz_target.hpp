#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "cmap/core/error.hpp"
#include "io/capture_json.hpp"
#include "io/file_format.hpp"
#include "io/format_readers.hpp"
#include "io/session_arrays.hpp"

namespace cmap::fuzz {

using Reader = PointCloud (*)(ByteSource&, FileInfo&);

/// Whatever the content says it is.
inline PointCloud read_any(ByteSource& source, FileInfo& info) { return detect_format(source).read(source, info); }

/// One input for one reader, which must read it or refuse it. The small blocks of a source in memory make the input
/// cross their borders.
inline void try_reader(Reader reader, std::span<const std::byte> input) {
  try {
    ByteSource source("input", input);
    FileInfo info;
    const PointCloud cloud = reader(source, info);
    if (cloud.size() != info.finite_points || cloud.size() == 0) __builtin_trap();
    for (const Eigen::Vector3f& p : cloud.positions) {
      if (!p.allFinite()) __builtin_trap();
    }
  } catch (const InputError&) {
    // a refusal is an answer
  }
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
    read_cameras(store, session, frames);
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

inline int run(Reader reader, const std::uint8_t* data, std::size_t size) {
  try_reader(reader, std::as_bytes(std::span(data, size)));
  return 0;
}

}  // namespace cmap::fuzz
