#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cmap {

/// Reads a 4x4 transform: text with 16 numbers, row-major (CloudCompare's and MapEval's form; `#` comments), or JSON
/// ([[4x4]], or an object whose key "T" or single 4x4 member holds it). Throws InputError naming file, line and reason:
/// not 16 finite numbers, last row not 0 0 0 1, a linear part that is no rotation times a positive scale (to 1e-3).
Eigen::Matrix4d read_transform(const std::filesystem::path& path);

/// The same, to write: four lines of four numbers that read back as they are, and rows [[4x4]].
std::string transform_text(const Eigen::Matrix4d& T);
nlohmann::ordered_json transform_json(const Eigen::Matrix4d& T);

}  // namespace cmap
