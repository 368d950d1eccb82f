#pragma once

// What programs share about the files of their command line; an empty path is one that was not given.

#include <fmt/format.h>

#include <Eigen/Core>
#include <cstdio>
#include <filesystem>
#include <optional>
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

/// The identity where no file was given; what is said of a file is added to `warnings`.
inline Eigen::Matrix4d transform_or_identity(const std::string& path, std::vector<Warning>& warnings) {
  if (path.empty()) return Eigen::Matrix4d::Identity();
  const TransformFile file = read_transform(path);
  warnings.insert(warnings.end(), file.warnings.begin(), file.warnings.end());
  return file.T;
}

/// For programs whose results have no place for warnings.
inline void print_warnings(const std::vector<Warning>& warnings) {
  for (const Warning& warning : warnings) fmt::print(stderr, "warning: {}\n", warning.message);
}

inline std::optional<std::filesystem::path> path_if_given(const std::string& path) {
  return path.empty() ? std::nullopt : std::optional<std::filesystem::path>(path);
}

}  // namespace cmap
