#include "sessions/shared_frames.hpp"

#include <cmath>

namespace cmap {

std::vector<FramePair> shared_frames(std::span<const double> time_s_a, std::span<const double> time_s_b,
                                     double same_frame_s) {
  std::vector<FramePair> shared;
  for (std::size_t i = 0, j = 0; i < time_s_a.size() && j < time_s_b.size();) {
    const double difference = time_s_a[i] - time_s_b[j];
    if (std::abs(difference) <= same_frame_s) {
      shared.push_back({i++, j++});
    } else {
      difference < 0.0 ? ++i : ++j;
    }
  }
  return shared;
}

}  // namespace cmap
