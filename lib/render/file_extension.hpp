#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

#include "cmap/core/spelling.hpp"

namespace cmap {

/// ".png" of "Figure.PNG"
inline std::string lower_case_extension(const std::filesystem::path& name) {
  return lower_case(name.extension().string());
}

}  // namespace cmap
