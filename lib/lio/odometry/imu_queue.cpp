#include "odometry/imu_queue.hpp"

#include <algorithm>
#include <cmath>

namespace cmap {
namespace {

/// Between two samples, linear.
ImuSample sample_at(const ImuSample& a, const ImuSample& b, double time_s) {
  const double share = std::clamp((time_s - a.time_s) / (b.time_s - a.time_s), 0.0, 1.0);
  return {time_s, a.angular_rate_radps + share * (b.angular_rate_radps - a.angular_rate_radps),
          a.specific_force_mps2 + share * (b.specific_force_mps2 - a.specific_force_mps2)};
}

MotionInput guessed(double duration_s, const Eigen::Vector3d& rate) {
  return {.duration_s = duration_s, .rate_radps = rate, .rate_measured = false, .force_measured = false};
}

}  // namespace

bool ImuQueue::add(const ImuSample& sample) {
  if (!std::isfinite(sample.time_s)) return false;
  if (!samples_.empty()) {
    if (!(sample.time_s > last_s())) return false;
    if (sample.time_s - last_s() > max_gap_s_) ++n_gaps_;
  }
  samples_.push_back(sample);
  return true;
}

void ImuQueue::forget_before(double time_s) {
  while (samples_.size() > 1 && samples_[1].time_s <= time_s) samples_.pop_front();
}

std::vector<MotionInput> ImuQueue::inputs(double from_s, double to_s) const {
  std::vector<MotionInput> steps;
  auto after = std::ranges::upper_bound(samples_, from_s, {}, &ImuSample::time_s);
  for (double t = from_s; t < to_s;) {
    const bool measured =
        after != samples_.begin() && after != samples_.end() && after->time_s - (after - 1)->time_s <= max_gap_s_;
    const double next = after == samples_.end() ? to_s : std::min(to_s, after->time_s);
    if (measured) {
      const ImuSample a = sample_at(*(after - 1), *after, t), b = sample_at(*(after - 1), *after, next);
      steps.push_back({.duration_s = next - t,
                       .rate_radps = 0.5 * (a.angular_rate_radps + b.angular_rate_radps),
                       .force_mps2 = 0.5 * (a.specific_force_mps2 + b.specific_force_mps2)});
    } else if (!samples_.empty()) {
      const ImuSample& nearest = after == samples_.begin() ? *after : *(after - 1);
      steps.push_back(guessed(next - t, nearest.angular_rate_radps));
    } else {
      steps.push_back(guessed(next - t, Eigen::Vector3d::Zero()));
    }
    t = next;
    if (after != samples_.end()) ++after;
  }
  std::erase_if(steps, [](const MotionInput& step) { return !(step.duration_s > 0.0); });
  return steps;
}

std::vector<ImuSample> ImuQueue::between(double from_s, double to_s) const {
  std::vector<ImuSample> found;
  for (const ImuSample& sample : samples_) {
    if (sample.time_s >= from_s && sample.time_s <= to_s) found.push_back(sample);
  }
  return found;
}

}  // namespace cmap
