#pragma once

#include <deque>
#include <vector>

#include "cmap/geometry/imu_sample.hpp"
#include "filter/propagation.hpp"

namespace cmap {

/// Samples of an IMU that are still needed, and the motion between any two times by them.
class ImuQueue {
 public:
  explicit ImuQueue(double max_gap_s) : max_gap_s_(max_gap_s) {}

  /// False where the sample is no later than the last, or its time is no number.
  bool add(const ImuSample& sample);
  /// Forgets what only times before this one need.
  void forget_before(double time_s);

  bool empty() const { return samples_.empty(); }
  double first_s() const { return samples_.front().time_s; }
  double last_s() const { return samples_.back().time_s; }

  /// Steps from one time to the next sample, and so on, until `to_s`. Rate and force are means over the step, linear
  /// between samples. Over gaps, and after the last sample, the last rate is guessed to stay.
  std::vector<MotionInput> inputs(double from_s, double to_s) const;
  /// Samples within the times.
  std::vector<ImuSample> between(double from_s, double to_s) const;
  std::size_t n_gaps() const { return n_gaps_; }

 private:
  std::deque<ImuSample> samples_;
  double max_gap_s_;
  std::size_t n_gaps_ = 0;
};

}  // namespace cmap
