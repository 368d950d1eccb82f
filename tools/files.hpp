#pragma once

// What programs share about the files of their command line; an empty path is one that was not given.

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/transform_file.hpp"

namespace cmap {

inline bool is_standard_output(const std::string& output) {
  return output == kStandardStream || output == "/dev/stdout" || output == "/dev/fd/1" || output == "/proc/self/fd/1";
}

/// Where an output goes to standard output, nothing else does.
inline bool any_to_standard_output(const std::vector<std::string>& outputs) {
  return std::ranges::any_of(outputs, is_standard_output);
}

/// A stream: what is read from it and what is written to it is not the same.
inline bool is_stream(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code missing;
  return path == kStandardStream || (fs::exists(path, missing) && !fs::is_regular_file(path, missing));
}

/// Inputs are never modified: an output must be neither one of them, under whatever name, nor another output.
/// Standard input can be read once, and one output can go to standard output.
inline void refuse_overwriting(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  if (std::ranges::count(inputs, kStandardStream) > 1) {
    throw UsageError("-: standard input can be read only once");
  }
  if (std::ranges::count_if(outputs, is_standard_output) > 1) {
    throw UsageError("standard output can take only one of the outputs");
  }
  std::vector<std::string> taken = inputs;
  for (const std::string& output : outputs) {
    if (output.empty() || is_stream(output)) continue;
    for (const std::string& other : taken) {
      if (other.empty() || is_stream(other)) continue;
      std::error_code missing;
      if (place_of_file(output) == place_of_file(other) || std::filesystem::equivalent(output, other, missing)) {
        throw UsageError(fmt::format("{}: would overwrite {}", output, other));
      }
    }
    taken.push_back(output);
  }
}

/// A name without any extension is the user's business.
inline void check_extension(const std::string& output, const std::vector<std::string>& right, const char* what_it_is) {
  const std::string extension = std::filesystem::path(output).extension().string();
  if (extension.empty() || std::ranges::count(right, extension) > 0) return;
  throw UsageError(fmt::format("{}: {}; give it a name that ends in {}", output, what_it_is, right.front()));
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
