#include "sensors/lio_drift.hpp"

#include <cmath>
#include <numbers>

#include "cmap/sim/random_stream.hpp"

namespace cmap {

Trajectory true_trajectory(const PoseSpline& path, const std::vector<double>& times_s) {
  Trajectory trajectory;
  for (const double t : times_s) {
    const Eigen::Isometry3d T = path.pose(t);
    trajectory.push_back({t, T.translation(), Eigen::Quaterniond(T.linear())});
  }
  return trajectory;
}

Trajectory with_lio_drift(Trajectory poses, const StatedOptions& o, std::uint64_t seed) {
  RandomStream random(seed, kRandomLioDrift);
  Eigen::Vector3d shift = Eigen::Vector3d::Zero(), turn_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d before = poses.empty() ? Eigen::Vector3d::Zero() : poses.front().position;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    StampedPose& pose = poses[i];
    if (i > 0) {
      const double root_way = std::sqrt((pose.position - before).norm());
      for (double& v : shift) v += o.lio_drift_m_per_sqrt_m * root_way * random.normal();
      for (double& v : turn_rad) {
        v += o.lio_drift_deg_per_sqrt_m * std::numbers::pi / 180.0 * root_way * random.normal();
      }
    }
    before = pose.position;
    pose.position += shift;
    const double angle = turn_rad.norm();
    if (angle > 0.0) pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn_rad / angle)) * pose.rotation;
  }
  return poses;
}

}  // namespace cmap
