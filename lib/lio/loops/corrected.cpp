#include <algorithm>
#include <stdexcept>

#include "cmap/geometry/rotation.hpp"
#include "cmap/lio/loop_closure.hpp"

namespace cmap {
namespace {

Eigen::Isometry3d pose_of(const StampedPose& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = pose.rotation.toRotationMatrix();
  T.translation() = pose.position;
  return T;
}

/// A share of a small motion: of its translation, and of its turn along the shortest arc.
Eigen::Isometry3d share_of(const Eigen::Isometry3d& motion, double share) {
  Eigen::Isometry3d part = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d turn = rotation_log(Eigen::Quaterniond(motion.linear()));
  part.linear() = rotation_exp(share * turn).toRotationMatrix();
  part.translation() = share * motion.translation();
  return part;
}

void check(std::span<const double> times_s, std::span<const Eigen::Isometry3d> before,
           std::span<const Eigen::Isometry3d> after) {
  if (times_s.empty() || times_s.size() != before.size() || times_s.size() != after.size()) {
    throw std::invalid_argument("a correction needs keyframes, and as many times and poses");
  }
  for (std::size_t k = 1; k < times_s.size(); ++k) {
    if (!(times_s[k] > times_s[k - 1])) throw std::invalid_argument("times of keyframes do not increase");
  }
}

}  // namespace

Trajectory corrected(const Trajectory& odometry, std::span<const double> times_s,
                     std::span<const Eigen::Isometry3d> before, std::span<const Eigen::Isometry3d> after) {
  check(times_s, before, after);
  Trajectory result;
  for (const StampedPose& pose : odometry) {
    // The last keyframe that is not later, but for the first.
    const auto later = std::upper_bound(times_s.begin(), times_s.end(), pose.time_s);
    const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(later - times_s.begin() - 1, 0));
    Eigen::Isometry3d change = Eigen::Isometry3d::Identity();
    if (k + 1 < times_s.size() && pose.time_s > times_s[k]) {
      const double share = (pose.time_s - times_s[k]) / (times_s[k + 1] - times_s[k]);
      change = share_of(after[k].inverse() * after[k + 1] * before[k + 1].inverse() * before[k], share);
    }
    const Eigen::Isometry3d T = after[k] * change * before[k].inverse() * pose_of(pose);
    result.push_back({pose.time_s, T.translation(), Eigen::Quaterniond(T.linear()).normalized()});
  }
  return result;
}

}  // namespace cmap
