#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace cmap {

/// A frame of one session and the frame of another that is the same picture.
struct FramePair {
  std::size_t a, b;
};

/// Frames whose times are no farther apart than same_frame_s; both lists ascend.
std::vector<FramePair> shared_frames(std::span<const double> time_s_a, std::span<const double> time_s_b,
                                     double same_frame_s);

}  // namespace cmap
