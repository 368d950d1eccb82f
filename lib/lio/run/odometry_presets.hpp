#pragma once

#include <span>
#include <string_view>

namespace cmap {

/// A configuration of configs/lio/, compiled in: presets work wherever the program is installed.
struct OdometryPreset {
  std::string_view name;
  std::string_view json;
};

std::span<const OdometryPreset> odometry_presets();

}  // namespace cmap
