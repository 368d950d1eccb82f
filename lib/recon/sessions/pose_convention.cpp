#include "sessions/pose_convention.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>

#include "cmap/core/error.hpp"
#include "degrees.hpp"

namespace cmap {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;

/// From OpenGL's camera axes (y up, z backward) to OpenCV's, and back.
Eigen::Isometry3d turned_axes() { return Eigen::Isometry3d(Eigen::DiagonalMatrix<double, 3>(1.0, -1.0, -1.0)); }

/// A way to read poses: camera from session as it should have been, of frame i of n.
struct Reading {
  const char* name;
  Eigen::Isometry3d (*pose)(const Poses& given, std::size_t i);
};

constexpr std::array<Reading, 4> kOtherReadings{{
    {"camera-to-world", [](const Poses& given, std::size_t i) { return given[i].inverse(); }},
    {"camera-to-world in OpenGL's axes (y up, z backward)",
     [](const Poses& given, std::size_t i) { return turned_axes() * given[i].inverse(); }},
    {"camera-from-world in OpenGL's axes (y up, z backward)",
     [](const Poses& given, std::size_t i) { return turned_axes() * given[i]; }},
    {"those of the frames from the last to the first",
     [](const Poses& given, std::size_t i) { return given[given.size() - 1 - i]; }},
}};

/// How the motion between frames agrees with odometry's.
struct Agreement {
  double cosine = 0.0;          ///< of the translations, long ones counting more
  double turn_error_rad = 0.0;  ///< mean
};

struct Motion {
  std::size_t i, j;
  Eigen::Isometry3d T_i_j;
};

Agreement agreement(const Poses& T_camera_session, std::span<const Motion> motions) {
  double dot = 0.0, sq_own = 0.0, sq_other = 0.0, error_rad = 0.0;
  for (const Motion& motion : motions) {
    const Eigen::Isometry3d T = T_camera_session[motion.i] * T_camera_session[motion.j].inverse();
    dot += T.translation().dot(motion.T_i_j.translation());
    sq_own += T.translation().squaredNorm();
    sq_other += motion.T_i_j.translation().squaredNorm();
    error_rad += rotation_angle_rad(T.linear().transpose() * motion.T_i_j.linear());
  }
  const double lengths = std::sqrt(sq_own * sq_other);
  return {lengths > 0.0 ? dot / lengths : 0.0, error_rad / static_cast<double>(motions.size())};
}

/// Odometry's motion between all pairs of a few dozen frames.
std::vector<Motion> motions_of(const OdometryPoses& T_world_camera) {
  constexpr std::size_t kMostFrames = 48;
  const std::size_t step = T_world_camera.size() / kMostFrames + 1;
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < T_world_camera.size(); i += step) {
    for (std::size_t j = i + step; j < T_world_camera.size(); j += step) {
      if (!T_world_camera[i] || !T_world_camera[j]) continue;
      motions.push_back({i, j, T_world_camera[i]->inverse() * *T_world_camera[j]});
    }
  }
  return motions;
}

/// What odometry says of the size of the motion.
struct MotionSize {
  double length_m = 0.0;  ///< root mean square
  double turn_rad = 0.0;  ///< mean
};

MotionSize size_of(std::span<const Motion> motions) {
  double sq_m = 0.0, rad = 0.0;
  for (const Motion& motion : motions) {
    sq_m += motion.T_i_j.translation().squaredNorm();
    rad += rotation_angle_rad(motion.T_i_j.linear());
  }
  const auto n = static_cast<double>(motions.size());
  return {std::sqrt(sq_m / n), rad / n};
}

/// Far from what a wrong calibration or a bent path does.
bool contradicts(const Agreement& found, const MotionSize& size, const PoseConventionOptions& o) {
  return (size.length_m >= o.min_length_m && found.cosine < o.contrary_cosine) ||
         (size.turn_rad >= o.min_turn_deg * kDegree_rad && found.turn_error_rad > o.contrary_turn * size.turn_rad);
}

bool agrees(const Agreement& found, const MotionSize& size, const PoseConventionOptions& o) {
  return (size.length_m < o.min_length_m || found.cosine > o.same_cosine) &&
         found.turn_error_rad < o.same_turn * size.turn_rad + o.same_turn_deg * kDegree_rad;
}

}  // namespace

std::optional<std::string> pose_convention_doubt(const Poses& given, const OdometryPoses& T_world_camera,
                                                 const PoseConventionOptions& options) {
  const std::vector<Motion> motions = motions_of(T_world_camera);
  if (motions.empty()) return std::nullopt;
  const MotionSize size = size_of(motions);
  if (!contradicts(agreement(given, motions), size, options)) return std::nullopt;
  std::vector<std::string> names;
  for (const Reading& reading : kOtherReadings) {
    Poses read;
    for (std::size_t i = 0; i < given.size(); ++i) read.push_back(reading.pose(given, i));
    if (agrees(agreement(read, motions), size, options)) names.emplace_back(reading.name);
  }
  if (names.empty()) return std::nullopt;
  return fmt::format(
      "the poses contradict the LiDAR-inertial ones, and agree with them as {}; camera-from-world in "
      "OpenCV's axes (x right, y down, z forward), first frame first, expected",
      fmt::join(names, ", or as "));
}

void require_pose_convention(const std::string& name, const SessionPredictions& session,
                             const OdometryPoses& T_world_camera, const PoseConventionOptions& options) {
  Poses given;
  for (const Eigen::Isometry3d& pose : session.T_camera_session) given.push_back(pose * session.T_session_file);
  if (const auto doubt = pose_convention_doubt(given, T_world_camera, options)) {
    throw InputError(fmt::format("{}: extrinsic: {}", name, *doubt));
  }
}

}  // namespace cmap
