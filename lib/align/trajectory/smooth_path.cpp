#include "trajectory/smooth_path.hpp"

#include <algorithm>

#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

Eigen::Vector3d chord(const StampedPose& a, const StampedPose& b) {
  return (b.position - a.position) / (b.time_s - a.time_s);
}

/// Not longer than the step's half: noise between two poses at nearly the same time is no bend.
Eigen::Vector3d limited(const Eigen::Vector3d& bend, double step_m) {
  const double length_m = bend.norm(), most_m = 0.5 * step_m;
  return length_m > most_m ? Eigen::Vector3d(most_m / length_m * bend) : bend;
}

}  // namespace

SmoothPath::SmoothPath(const Trajectory& trajectory, double max_gap_s)
    : trajectory_(&trajectory), max_gap_s_(max_gap_s), slopes_(trajectory.size(), Eigen::Vector3d::Zero()) {
  const std::size_t n = trajectory.size();
  if (n < 2) return;
  for (std::size_t i = 1; i + 1 < n; ++i) slopes_[i] = chord(trajectory[i - 1], trajectory[i + 1]);
  slopes_.front() = chord(trajectory[0], trajectory[1]);
  slopes_.back() = chord(trajectory[n - 2], trajectory[n - 1]);
}

std::optional<std::size_t> SmoothPath::segment(double time_s) const {
  const Trajectory& poses = *trajectory_;
  if (poses.size() < 2 || time_s < poses.front().time_s || time_s > poses.back().time_s) return std::nullopt;
  const auto after = std::ranges::upper_bound(poses, time_s, {}, &StampedPose::time_s);
  const auto index = static_cast<std::size_t>(after - poses.begin());
  const std::size_t begin = std::min(index, poses.size() - 1) - 1;
  if (poses[begin + 1].time_s - poses[begin].time_s > max_gap_s_) return std::nullopt;
  return begin;
}

std::optional<Eigen::Vector3d> SmoothPath::position(double time_s) const {
  const auto begin = segment(time_s);
  if (!begin) return std::nullopt;
  const StampedPose &a = (*trajectory_)[*begin], &b = (*trajectory_)[*begin + 1];
  const double length_s = b.time_s - a.time_s;
  const double u = (time_s - a.time_s) / length_s;
  const Eigen::Vector3d step = b.position - a.position;
  const Eigen::Vector3d bend_a = limited(length_s * slopes_[*begin] - step, step.norm());
  const Eigen::Vector3d bend_b = limited(step - length_s * slopes_[*begin + 1], step.norm());
  return Eigen::Vector3d(a.position + u * step + u * (1.0 - u) * ((1.0 - u) * bend_a + u * bend_b));
}

std::optional<Eigen::Quaterniond> SmoothPath::rotation(double time_s) const {
  const auto begin = segment(time_s);
  if (!begin) return std::nullopt;
  const StampedPose &a = (*trajectory_)[*begin], &b = (*trajectory_)[*begin + 1];
  return a.rotation.slerp((time_s - a.time_s) / (b.time_s - a.time_s), b.rotation);
}

double median_step_s(const Trajectory& trajectory) {
  if (trajectory.size() < 2) return 0.0;
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    steps_s.push_back(trajectory[i].time_s - trajectory[i - 1].time_s);
  }
  return upper_median(steps_s);
}

}  // namespace cmap
