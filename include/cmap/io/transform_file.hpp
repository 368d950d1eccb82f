#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cmap/core/warning.hpp"

namespace cmap {

/// A transform as a file gave it.
struct TransformFile {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();  ///< a rotation times a positive scale, and a translation
  std::vector<Warning> warnings;                    ///< each names the file
};

/// Reads one 4x4 or 3x4 transform, row-major:
/// - text: rows of numbers, or all 16 or 12 in a row, plain (CloudCompare's and MapEval's form) or as NumPy, PyTorch,
///   MATLAB and Eigen print them, with brackets, commas, semicolons; `#` comments;
/// - JSON: [[4x4]], [[3x4]] or the numbers in one list, alone or as the only matrix of an object ("T" first); evo's
///   object of x y z qx qy qz qw and scale;
/// - NumPy's .npy; COLMAP's and Open3D's .log of one pose.
/// Numbers in a row whose translation stands last are column-major, and read so with a warning. The last row may be
/// 1e-6 off 0 0 0 1 and the linear part 1e-3 off a rotation times a positive scale. A name that says that the matrix
/// maps the reference to the estimate ("T_est_ref") is refused, as every transform here maps the other way. Throws
/// InputError naming file, line where there is one, and reason for everything else. Thread-safe.
TransformFile read_transform(const std::filesystem::path& path);

/// The same, to write: four lines of four numbers that read back as they are, and rows [[4x4]].
std::string transform_text(const Eigen::Matrix4d& T);
nlohmann::ordered_json transform_json(const Eigen::Matrix4d& T);

}  // namespace cmap
