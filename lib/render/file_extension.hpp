#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace cmap {

/// ".png" of "Figure.PNG"
inline std::string lower_case_extension(const std::filesystem::path& name) {
  std::string extension = name.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

}  // namespace cmap
