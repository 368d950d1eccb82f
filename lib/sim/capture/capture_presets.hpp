#pragma once

#include <span>
#include <string_view>

namespace cmap {

/// A configuration of configs/sim/, compiled in: presets work wherever the program is installed.
struct CapturePreset {
  std::string_view name;
  std::string_view json;
};

std::span<const CapturePreset> capture_presets();

}  // namespace cmap
