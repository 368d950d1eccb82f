#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cmap {

/// Looks whether rows of numbers without names are another thing than points: a 4x4 or 3x4 transform, a rotation or
/// camera matrix, poses (rows of 12 or 16 numbers, TUM's 8, stacked 4x4 matrices with or without a line before each),
/// or fewer rows than columns, as of a transposed cloud. `rows` are the first rows of a file (a few dozen are enough;
/// they may differ in length), `complete` says whether there are no more. Returns what it is and what to do instead, to
/// follow the file's name; nothing where it may be points.
std::optional<std::string> not_a_cloud(std::span<const std::vector<double>> rows, bool complete);

/// The same by the names of columns: a time first, and a quaternion.
bool names_poses(std::span<const std::string> names);
std::string_view pose_hint();

}  // namespace cmap
