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
#include "recordings/mcap/mcap_store.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/topic_choice.hpp"

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

/// What is understood of a message holds nothing but numbers, in arrays that belong together.
inline void check_recorded(const RecordedMessage& message) {
  if (const auto* scan = std::get_if<LidarScan>(&message)) {
    const std::size_t n = scan->positions.size();
    for (const std::size_t length : {scan->intensity.size(), scan->time_s.size(), scan->ring.size()}) {
      if (length != 0 && length != n) __builtin_trap();
    }
    for (const Eigen::Vector3f& p : scan->positions) {
      if (!p.allFinite()) __builtin_trap();
    }
    for (const float time_s : scan->time_s) {
      if (!std::isfinite(time_s)) __builtin_trap();
    }
  } else if (const auto* image = std::get_if<RecordedImage>(&message)) {
    if (image->row_bytes * static_cast<std::size_t>(image->height) > image->bytes.size()) __builtin_trap();
  } else if (const auto* pose = std::get_if<StampedPose>(&message)) {
    if (!(std::abs(pose->rotation.norm() - 1.0) < 1e-9)) __builtin_trap();
  }
}

/// A message of a recording: the first byte says which kind, the next one in which encoding.
inline void try_recorded_message(std::span<const std::byte> input) {
  if (input.size() < 2) return;
  const auto kind = static_cast<MessageKind>(std::to_integer<unsigned>(input[0]) % 7U);  // all but the time reference
  const bool is_ros1 = (std::to_integer<unsigned>(input[1]) & 1U) != 0;
  try {
    MessageDecoder decoder(kind, is_ros1 ? MessageEncoding::kRos1 : MessageEncoding::kCdr, PointTimeUnit::kAuto, 1.0);
    check_recorded(decoder.decode(input.subspan(2), std::nullopt));
  } catch (const UnsupportedError&) {
    // so is what cannot be used
  } catch (const InputError&) {
    // a refusal is an answer
  }
}

/// An MCAP file, with whatever is understood of its messages.
inline void try_recording(std::span<const std::byte> input) {
  try {
    const auto store = open_mcap(std::make_unique<ByteSource>("input", input));
    std::vector<std::optional<MessageDecoder>> decoders;
    for (const StoredTopic& topic : store->topics()) {
      const std::optional<MessageKind> kind = kind_of(topic);
      decoders.emplace_back();
      if (kind && role_of(*kind)) decoders.back().emplace(*kind, topic.encoding(), PointTimeUnit::kAuto, 1.0);
    }
    StoredMessage message;
    while (store->next(message)) {
      if (message.topic >= decoders.size()) __builtin_trap();
      if (decoders[message.topic]) check_recorded(decoders[message.topic]->decode(message.data, std::nullopt));
    }
  } catch (const UnsupportedError&) {
    // so is what cannot be used
  } catch (const InputError&) {
    // a refusal is an answer
  }
}

}  // namespace cmap::fuzz
