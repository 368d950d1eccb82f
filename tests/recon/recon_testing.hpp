#pragma once

#include "align/align_testing.hpp"
#include "cmap/recon/session_placement.hpp"

namespace cmap::test {

/// Standard normal, Box and Muller's way: the same on every standard library.
inline double normal(std::mt19937_64& random) {
  const double u = 1.0 - uniform(random);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * uniform(random));
}

inline Eigen::Vector3d normal_vector(std::mt19937_64& random, double sigma) {
  const double x = normal(random), y = normal(random);
  return sigma * Eigen::Vector3d(x, y, normal(random));
}

/// About a random axis, by a normal angle.
inline Eigen::Matrix3d small_rotation(std::mt19937_64& random, double sigma_deg) {
  const Eigen::Vector3d axis = normal_vector(random, 1.0).normalized();
  return rotation_from(axis * normal(random) * sigma_deg * M_PI / 180.0);
}

/// A session in its own unit and frame, and the camera poses it was taken from.
struct SimulatedSession {
  Similarity truth;  ///< world from session
  std::vector<SessionFrame> frames;
  std::vector<std::optional<Eigen::Isometry3d>> T_world_camera;
};

struct SessionPath {
  std::size_t n = 30;
  double length_m = 60.0;
  double bow_m = 0.0;  ///< of y = bow / 2 (1 - cos 2 pi u): to one side and back
};

struct SessionNoise {
  double position_m = 0.0;
  double rotation_deg = 0.0;
  double extrinsic_deg = 0.0;  ///< a turn of all world rotations in the camera's axes: half along the path, half across
};

inline SimulatedSession simulated_session(const SessionPath& path, const SessionNoise& noise, std::mt19937_64& random) {
  SimulatedSession session;
  session.truth = random_similarity(random, 3.0, 30.0, 100.0);
  const Similarity session_world = session.truth.inverse();
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 1, 0).normalized();
  const Eigen::Matrix3d extrinsic = rotation_from(axis * noise.extrinsic_deg * M_PI / 180.0);
  const Eigen::Matrix3d heading = random_rotation(random);
  for (std::size_t i = 0; i < path.n; ++i) {
    const double u = path.n == 1 ? 0.0 : static_cast<double>(i) / static_cast<double>(path.n - 1);
    const Eigen::Vector3d center =
        heading * Eigen::Vector3d(path.length_m * u, 0.5 * path.bow_m * (1.0 - std::cos(2.0 * M_PI * u)), 0.0);
    const Eigen::Matrix3d R_world_camera = heading;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    T_world_camera.linear() = R_world_camera * extrinsic;
    T_world_camera.translation() = center;
    session.T_world_camera.emplace_back(T_world_camera);
    const Eigen::Vector3d seen = session_world * (center + normal_vector(random, noise.position_m));
    const Eigen::Matrix3d R_session_camera =
        session_world.rotation * R_world_camera * small_rotation(random, noise.rotation_deg);
    SessionFrame frame;
    frame.time_s = 0.1 * static_cast<double>(i);
    frame.T_camera_session.linear() = R_session_camera.transpose();
    frame.T_camera_session.translation() = -(R_session_camera.transpose() * seen);
    session.frames.push_back(frame);
  }
  return session;
}

inline double rotation_error_deg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return rotation_angle_rad(a.transpose() * b) * 180.0 / M_PI;
}

}  // namespace cmap::test
