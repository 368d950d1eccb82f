#pragma once

#include <numbers>

namespace cmap {

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

}  // namespace cmap
