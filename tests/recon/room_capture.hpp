#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cmap/io/capture.hpp"
#include "cmap/io/lidar_scan_file.hpp"
#include "cmap/io/session_file.hpp"
#include "cmap/recon/placed_session.hpp"
#include "cmap/recon/reconstruction.hpp"
#include "io/io_testing.hpp"

/// A capture made up of exact numbers: a body that crosses a room, a camera, a LiDAR, and what a network without errors
/// predicts, in sessions with units of their own.
namespace cmap::test {

/// Walls, floor and ceiling, and balls on the floor and under the ceiling that hold what would slide along walls; m.
/// A color tells the axis of a wall, or a ball.
struct Room {
  static constexpr std::array<double, 3> kLow{0, -4, -1.5}, kHigh{12, 4, 2.5};
  static constexpr double kRadius = 0.7;
  static constexpr std::size_t kBall = 3;

  struct Hit {
    double distance = INFINITY;
    std::size_t what = kBall;
  };

  static std::vector<Eigen::Vector3d> balls() {
    std::vector<Eigen::Vector3d> centers;
    for (int i = 0; i < 7; ++i) {
      for (const double side : {-1.0, 1.0}) {
        centers.emplace_back(1.0 + 1.7 * i, side * (2.4 + 0.3 * (i % 3)), i % 2 == 0 ? kLow[2] : kHigh[2] - 1.0);
      }
    }
    return centers;
  }
  static Hit hit(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
    static const std::vector<Eigen::Vector3d> kBalls = balls();
    Hit nearest;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double d = direction[static_cast<int>(axis)], wall = d > 0 ? kHigh[axis] : kLow[axis];
      const double distance = (wall - from[static_cast<int>(axis)]) / d;
      if (distance < nearest.distance) nearest = {distance, axis};
    }
    for (const Eigen::Vector3d& center : kBalls) {
      const Eigen::Vector3d to = center - from;
      const double a = direction.squaredNorm(), b = direction.dot(to);
      const double root = b * b - a * (to.squaredNorm() - kRadius * kRadius);
      const double distance = (b - std::sqrt(std::max(0.0, root))) / a;
      if (root > 0.0 && distance > 0.0 && distance < nearest.distance) nearest = {distance, kBall};
    }
    return nearest;
  }
  /// From a point to the nearest wall or ball.
  static double off_m(const Eigen::Vector3d& p) {
    double off = INFINITY;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = p[static_cast<int>(axis)];
      off = std::min({off, std::abs(value - kLow[axis]), std::abs(value - kHigh[axis])});
    }
    for (const Eigen::Vector3d& center : balls()) off = std::min(off, std::abs((p - center).norm() - kRadius));
    return off;
  }
  static Rgb8 color(std::size_t what) {
    constexpr std::array<Rgb8, 4> kColors{{{200, 40, 40}, {40, 200, 40}, {40, 40, 200}, {200, 200, 40}}};
    return kColors[what];
  }
};

/// Meters in the unit of each session: five frames each, two shared with the next.
inline constexpr std::array kUnits_m{2.0, 0.5, 1.25};
inline constexpr std::size_t kFramesEach = 5, kFramesApart = 3;
inline constexpr double kFrameStep_s = 0.5;

inline StampedPose room_body_at(double time_s) {
  const double x = 2.0 + 1.2 * time_s;
  return {time_s,
          {x, 0.8 * std::sin(0.5 * x), 0.0},
          Eigen::Quaterniond(Eigen::AngleAxisd(0.2 * std::sin(time_s), Eigen::Vector3d::UnitZ()))};
}

inline CaptureCalibration room_calibration() {
  CaptureCalibration calibration;
  calibration.camera.width = 48;
  calibration.camera.height = 36;
  calibration.camera.fx = calibration.camera.fy = 24.0;
  calibration.camera.cx = 23.5;
  calibration.camera.cy = 17.5;
  calibration.T_imu_lidar.translation() << 0.1, 0.0, 0.2;
  calibration.T_lidar_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // the camera looks along the LiDAR's x
  calibration.T_lidar_camera.translation() << 0.15, 0.05, -0.1;
  return calibration;
}

inline Eigen::Isometry3d room_camera_at(double time_s) {
  const StampedPose body = room_body_at(time_s);
  const CaptureCalibration c = room_calibration();
  return Eigen::Translation3d(body.position) * body.rotation * c.T_imu_lidar * c.T_lidar_camera;
}

inline double frame_time_s(std::size_t session, std::size_t frame) {
  return kFrameStep_s * static_cast<double>(kFramesApart * session + frame);
}

inline SessionPredictions room_session(std::size_t k) {
  const CameraModel camera = room_calibration().camera;
  SessionPredictions session;
  session.width = camera.width;
  session.height = camera.height;
  for (std::size_t i = 0; i < kFramesEach; ++i) {
    const double time_s = frame_time_s(k, i);
    session.frames.push_back({i, time_s, fmt::format("{}.jpg", i), camera.width, camera.height});
    const Eigen::Isometry3d T_world_camera = room_camera_at(time_s);
    Eigen::Isometry3d T_camera_session = T_world_camera.inverse() * room_camera_at(frame_time_s(k, 0));
    T_camera_session.translation() /= kUnits_m[k];
    session.T_camera_session.push_back(T_camera_session);
    session.intrinsics.push_back(
        (Eigen::Matrix3d() << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1).finished());
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
        const Room::Hit hit = Room::hit(T_world_camera.translation(), T_world_camera.linear() * ray);
        session.depth.push_back(static_cast<float>(hit.distance / kUnits_m[k]));
        session.depth_confidence.push_back(3.0F);
        session.images.push_back(Room::color(hit.what));
      }
    }
  }
  return session;
}

inline LidarScan room_scan(double time_s) {
  const StampedPose body = room_body_at(time_s);
  const Eigen::Isometry3d T_world_lidar =
      Eigen::Translation3d(body.position) * body.rotation * room_calibration().T_imu_lidar;
  LidarScan scan;
  scan.timestamp_s = time_s;
  for (int ring = -20; ring <= 20; ++ring) {
    for (int step = 0; step < 180; ++step) {
      const double azimuth = step * M_PI / 90.0 + 0.003, elevation = ring * M_PI / 90.0 + 0.002;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      const double range_m = Room::hit(T_world_lidar.translation(), T_world_lidar.linear() * ray).distance;
      scan.positions.push_back((range_m * ray).cast<float>());
    }
  }
  return scan;
}

/// On disk as long as it lives, and opened.
class RoomCapture {
 public:
  RoomCapture() {
    CaptureWriter writer(path(), room_calibration());
    Trajectory lio;
    for (int i = -10; i <= 70; ++i) lio.push_back(room_body_at(0.1 * i));
    writer.write_lio(lio);
    const std::size_t n_frames = kFramesApart * (kUnits_m.size() - 1) + kFramesEach;
    for (std::size_t i = 0; i < n_frames; ++i) writer.add_scan(room_scan(kFrameStep_s * static_cast<double>(i)));
    for (std::size_t k = 0; k < kUnits_m.size(); ++k) writer.add_session(room_session(k));
    writer.commit();
  }

  std::filesystem::path path() const { return folder_ / "capture"; }
  std::filesystem::path session(std::size_t k) const { return path() / fmt::format("predictions/session_{:04}", k); }
  Capture open() const { return open_capture(path(), parts_needed({}, Stage::kFusion)); }
  /// Beside the capture, for results.
  std::filesystem::path beside(std::string_view name) const { return folder_ / name; }

 private:
  testing::TempFolder folder_;
};

/// The largest distance of a session's cameras from where they are.
inline double camera_error_m(const PlacedSession& session) {
  double worst_m = 0.0;
  for (std::size_t i = 0; i < session.time_s.size(); ++i) {
    const Eigen::Vector3d truth = room_camera_at(session.time_s[i]).translation();
    worst_m = std::max(worst_m, (session.T_world_camera[i].translation() - truth).norm());
  }
  return worst_m;
}

}  // namespace cmap::test
