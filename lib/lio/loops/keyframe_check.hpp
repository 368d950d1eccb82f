#pragma once

#include <span>

#include "cmap/lio/keyframe.hpp"

namespace cmap {

/// Throws std::invalid_argument, naming the keyframe, where a time, pose or point is not finite, a pose is no rotation
/// and translation (beyond 1e-3), or times do not increase.
void check_keyframes(std::span<const Keyframe> keyframes);

}  // namespace cmap
