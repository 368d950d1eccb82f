#pragma once

#include <array>
#include <vector>

#include "trajectory/smooth_path.hpp"

namespace cmap {

/// How a body moves, in numbers that do not depend on its frames: speed, turn rate of the body and turn rate of the
/// path, at equal steps; NaN where the path is not known.
struct MotionProfile {
  static constexpr std::size_t kKinds = 3;
  double begin_s = 0.0, step_s = 0.0;
  std::array<std::vector<double>, kKinds> values;

  std::size_t size() const { return values[0].size(); }
};

/// Derivatives over step_s forth and back, but at least over 0.2 s; values beyond three times the 90 % quantile are cut
/// there, so that poses that jump do not decide.
MotionProfile motion_profile(const Trajectory& trajectory, double step_s, double max_gap_s);

/// Offsets to add to the source's times at which the profiles correlate best, the best first, at most `n` and no two
/// nearer than two steps. At each, at least `min_overlap` of the shorter profile must be shared.
std::vector<double> best_offsets_s(const MotionProfile& source, const MotionProfile& target, double min_overlap,
                                   std::size_t n);

}  // namespace cmap
