#pragma once

#include <span>
#include <string_view>

namespace cmap {

/// A configuration of configs/, compiled in: presets work wherever the program is installed.
struct Preset {
  std::string_view name;
  std::string_view json;
};

std::span<const Preset> presets();

}  // namespace cmap
