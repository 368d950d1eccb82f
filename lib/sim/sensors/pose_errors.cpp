#include "sensors/pose_errors.hpp"

#include <numbers>

#include "cmap/geometry/rotation.hpp"
#include "cmap/sim/random_stream.hpp"

namespace cmap {
namespace {

Eigen::Vector3d normals(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

Eigen::Matrix3d turn_of(const Eigen::Vector3d& angles_deg) {
  return rotation_from(angles_deg * (std::numbers::pi / 180.0));
}

/// The motion from one frame to the next, a little wrong.
Eigen::Isometry3d with_drift(Eigen::Isometry3d step, double scale, const PredictionOptions& o, RandomStream& random) {
  const double length = step.translation().norm();
  step.translation() = scale * step.translation() + o.pose_drift_fraction * length * normals(random);
  step.linear() = step.linear() * turn_of(o.pose_drift_deg_per_frame * normals(random));
  return step;
}

Eigen::Isometry3d with_noise(Eigen::Isometry3d T, const PredictionOptions& o, RandomStream& random) {
  T.translation() += o.pose_noise_m * normals(random);
  T.linear() = T.linear() * turn_of(o.pose_noise_deg * normals(random));
  return T;
}

}  // namespace

std::vector<Eigen::Isometry3d> with_pose_errors(const std::vector<Eigen::Isometry3d>& T_world_camera,
                                                std::size_t session, double stretch, const PredictionOptions& o,
                                                std::uint64_t seed) {
  RandomStream random(seed, kRandomSessionPose, session);
  const double scale = 1.0 + o.pose_scale_fraction * random.normal();
  std::vector<Eigen::Isometry3d> predicted{Eigen::Isometry3d::Identity()};
  Eigen::Isometry3d chained = Eigen::Isometry3d::Identity();
  for (std::size_t i = 1; i < T_world_camera.size(); ++i) {
    chained = chained * with_drift(T_world_camera[i - 1].inverse() * T_world_camera[i], scale, o, random);
    predicted.push_back(with_noise(chained, o, random));
    predicted.back().translation() *= stretch;
  }
  return predicted;
}

}  // namespace cmap
