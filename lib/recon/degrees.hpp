#pragma once

#include <numbers>

namespace cmap {

inline constexpr double kDegree_rad = std::numbers::pi / 180.0;

}  // namespace cmap
