#pragma once

// What programs share about the files of their command line; an empty path is one that was not given.

#include <fmt/format.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "cmap/core/error.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/transform_file.hpp"

namespace cmap {

/// Inputs are never modified: an output must not be one of them, under whatever name, nor another output.
inline void refuse_overwriting(std::vector<std::string> inputs, const std::vector<std::string>& outputs) {
  namespace fs = std::filesystem;
  std::vector<std::string>& taken = inputs;
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    for (const std::string& other : taken) {
      std::error_code missing;
      const bool is_device = fs::exists(output, missing) && !fs::is_regular_file(output, missing);
      if (other.empty() || is_device) continue;
      if (fs::weakly_canonical(output) == fs::weakly_canonical(other) || fs::equivalent(output, other, missing)) {
        throw UsageError(fmt::format("{}: would overwrite {}", output, other));
      }
    }
    taken.push_back(output);
  }
}

/// The identity where no file was given.
inline Eigen::Matrix4d transform_or_identity(const std::string& path) {
  return path.empty() ? Eigen::Matrix4d::Identity().eval() : read_transform(path);
}

}  // namespace cmap
